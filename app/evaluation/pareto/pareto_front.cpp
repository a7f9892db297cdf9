// pareto_front.cpp: computes the front in one pass over the points sorted by cost.
#include "app/evaluation/pareto/pareto_front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace roomradar {

std::vector<std::size_t> pareto_front_of(const std::vector<CostAndError>& points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(points[i].cost) && std::isfinite(points[i].error)) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(points[a].cost, points[a].error, a) < std::tie(points[b].cost, points[b].error, b);
  });
  std::vector<std::size_t> front;
  double least_error = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    if (!(points[i].error < least_error)) continue;
    least_error = points[i].error;
    front.push_back(i);
  }
  return front;
}

}  // namespace roomradar
