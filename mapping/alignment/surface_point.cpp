// surface_point.cpp: 3D surface point at a colour pixel.
#include "mapping/alignment/surface_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomradar {
namespace {

/// Returns the median depth of a pixel's 3 x 3 neighbourhood; 0 if fewer than five of its pixels have depth.
float median_depth_m(const DepthImage& depth_m, int x, int y) {
  std::array<float, 9> around{};
  std::size_t count = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, depth_m.height - 1); ++v) {
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, depth_m.width - 1); ++u) {
      if (depth_m.at(u, v) > 0.0F) around[count++] = depth_m.at(u, v);
    }
  }
  if (count < 5) return 0.0F;
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(around.begin(), middle, around.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

}  // namespace

std::optional<Eigen::Vector3f> surface_point_at(const Frame& frame, const Eigen::Isometry3d& T_depth_colour,
                                                double u_px, double v_px) {
  for (const double start_m : {0.8, 3.0}) {
    double z_colour_m = start_m;
    for (int step = 0; step < 8; ++step) {
      const Eigen::Vector3d p = T_depth_colour * back_project(frame.colour_camera, u_px, v_px, z_colour_m);
      if (p.z() < 0.1) break;
      const Eigen::Vector2d at_px = project(frame.depth_camera, p);
      if (!(at_px.cwiseAbs().maxCoeff() < 1e5)) break;
      const int x = static_cast<int>(std::lround(at_px.x())), y = static_cast<int>(std::lround(at_px.y()));
      if (!frame.depth_m.contains(x, y)) break;
      const auto depth_m = static_cast<double>(median_depth_m(frame.depth_m, x, y));
      if (depth_m <= 0.0) break;
      const Eigen::Vector3d seen = p * (depth_m / p.z());
      const double next_m = (frame.T_colour_depth * seen).z();
      if (std::abs(next_m - z_colour_m) < 0.01 * next_m) return seen.cast<float>();
      z_colour_m = next_m;
    }
  }
  return std::nullopt;
}

}  // namespace roomradar
