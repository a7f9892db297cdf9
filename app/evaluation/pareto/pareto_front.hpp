// pareto_front.hpp: Pareto front of cost and error.
#pragma once
#include <cstddef>
#include <vector>

namespace roomradar {

struct CostAndError {
  double cost = 0.0;
  double error = 0.0;
};

/// Returns the indices of the points that no other point dominates (neither cost nor error larger, one
/// smaller), in order of increasing cost. Of equal points, only the first is returned. Points that are not
/// finite are never returned.
std::vector<std::size_t> pareto_front_of(const std::vector<CostAndError>& points);

}  // namespace roomradar
