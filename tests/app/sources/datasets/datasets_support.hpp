// datasets_support.hpp: agreement of depth images with recorded poses.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "mapping/types/frame.hpp"

namespace roomradar::test {

/// Median distance along the axis of b between points of frame a, moved by the recorded poses, and the depth
/// of frame b where they project; -1 with fewer than 100 such points. Points farther than 0.3 m from the
/// depth of b are hidden and left out.
inline double median_disagreement_m(const Frame& a, const Frame& b) {
  constexpr double kHidden_m = 0.3;
  const Eigen::Isometry3d T_b_a = b.T_world_camera->inverse() * *a.T_world_camera;
  std::vector<double> distances_m;
  for (int y = 0; y < a.depth_m.height; y += 3)
    for (int x = 0; x < a.depth_m.width; x += 3) {
      const double z = static_cast<double>(a.depth_m.at(x, y));
      if (z <= 0.0) continue;
      const Eigen::Vector3d p_b = T_b_a * back_project(a.depth_camera, x, y, z);
      if (p_b.z() < 0.1) continue;
      const Eigen::Vector2d at = project(b.depth_camera, p_b);
      const int u = static_cast<int>(std::lround(at.x())), v = static_cast<int>(std::lround(at.y()));
      if (!b.depth_m.contains(u, v) || b.depth_m.at(u, v) <= 0.0F) continue;
      const double distance_m = std::abs(static_cast<double>(b.depth_m.at(u, v)) - p_b.z());
      if (distance_m < kHidden_m) distances_m.push_back(distance_m);
    }
  if (distances_m.size() < 100) return -1.0;
  std::nth_element(distances_m.begin(), distances_m.begin() + std::ssize(distances_m) / 2, distances_m.end());
  return distances_m[distances_m.size() / 2];
}

}  // namespace roomradar::test
