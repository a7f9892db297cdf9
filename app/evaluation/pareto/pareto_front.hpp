// front.hpp: of what was measured, what nothing else beats in both time and error.
#pragma once
#include <cstddef>
#include <vector>

namespace roomradar {

struct CostAndError {
  double cost = 0.0;
  double error = 0.0;
};

/// Whether a is nowhere worse than b and somewhere better.
bool dominates(const CostAndError& a, const CostAndError& b);

/// Places of the points that no other one dominates, cheapest first; of points alike, the first. Points with
/// a number that is not finite are never on a front.
std::vector<std::size_t> pareto_front_of(const std::vector<CostAndError>& points);

}  // namespace roomradar
