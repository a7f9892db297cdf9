// pareto_front.hpp: Pareto front of cost and error.
#pragma once
#include <cstddef>
#include <vector>

namespace roomradar {

struct CostAndError {
  double cost = 0.0;
  double error = 0.0;
};

/// Returns true if neither cost nor error of a is larger than b's, and one is smaller.
bool dominates(const CostAndError& a, const CostAndError& b);

/// Returns the indices of the points that no other point dominates, in order of increasing cost. Of equal
/// points, only the first is returned. Points that are not finite are never returned.
std::vector<std::size_t> pareto_front_of(const std::vector<CostAndError>& points);

}  // namespace roomradar
