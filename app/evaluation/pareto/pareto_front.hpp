// pareto_front.hpp: Pareto front of cost and error.
#pragma once
#include <cstddef>
#include <vector>

namespace roomradar {

struct CostAndError {
  double cost = 0.0;
  double error = 0.0;
};

/// Returns true if a is nowhere worse than b and somewhere better.
bool dominates(const CostAndError& a, const CostAndError& b);

/// Returns the indices of the points that no other point dominates, cheapest first; of equal points only the
/// first. Points that are not finite are never on the front.
std::vector<std::size_t> pareto_front_of(const std::vector<CostAndError>& points);

}  // namespace roomradar
