// view_selection.cpp: divides a scan into segments with almost the same view, and chooses the slowest frame
// of each.
#include "mapping/texture/view_selection.hpp"

#include <algorithm>

namespace roomradar {
namespace {

constexpr double kStep_m = 0.05, kStep_rad = 0.05;
constexpr double kLonger = 1.25;  // factor on both if there are too many parts

bool is_within(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double steps) {
  const Eigen::Isometry3d moved = a.inverse() * b;
  return moved.translation().norm() < steps * kStep_m &&
         Eigen::AngleAxisd(moved.linear()).angle() < steps * kStep_rad;
}

std::vector<std::size_t> one_per_part(std::span<const ViewCandidate> candidates, double steps) {
  std::vector<std::size_t> chosen;
  for (std::size_t first = 0, end = 0; first < candidates.size(); first = end) {
    std::size_t slowest = first;
    for (end = first;
         end < candidates.size() &&
         (end == first || is_within(candidates[first].T_world_camera, candidates[end].T_world_camera, steps));
         ++end)
      if (candidates[end].image_speed_pxps < candidates[slowest].image_speed_pxps) slowest = end;
    const bool is_known = std::any_of(chosen.begin(), chosen.end(), [&](std::size_t i) {
      return is_within(candidates[i].T_world_camera, candidates[slowest].T_world_camera, 0.5 * steps);
    });
    if (!is_known) chosen.push_back(slowest);
  }
  return chosen;
}

}  // namespace

std::vector<std::size_t> choose_views(std::span<const ViewCandidate> candidates, std::size_t max_views) {
  if (max_views == 0) return {};
  double steps = 1.0;
  std::vector<std::size_t> chosen = one_per_part(candidates, steps);
  // Each round has fewer parts, and one part is left when a step spans the room.
  while (chosen.size() > max_views) chosen = one_per_part(candidates, steps *= kLonger);
  return chosen;
}

}  // namespace roomradar
