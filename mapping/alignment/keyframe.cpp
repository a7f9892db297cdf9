// keyframe.cpp: stored views that later frames are aligned with, and refinement of their depth.
#include "mapping/alignment/keyframe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapping/types/depth_noise.hpp"

namespace roomradar {
namespace {

constexpr int kMostMeasurements = 60;  // then the mean becomes a moving average

}  // namespace

double view_distance(const Eigen::Isometry3d& T_a_b) {
  constexpr double kFar_m = 0.8, kFar_rad = 35.0 * std::numbers::pi / 180.0;
  return T_a_b.translation().norm() / kFar_m + Eigen::AngleAxisd(T_a_b.linear()).angle() / kFar_rad;
}

StoredView store(const ViewPyramid& pyramid, const Image<std::uint8_t>& measured) {
  const ViewPyramid::Level& finest = pyramid.levels.front();
  StoredView view;
  view.camera = finest.camera;
  view.noise = pyramid.noise;
  view.measured = measured;
  view.inverse_depth.resize(finest.camera.width_px, finest.camera.height_px);
  std::transform(finest.inverse_depth_per_m.pixels.begin(), finest.inverse_depth_per_m.pixels.end(),
                 view.inverse_depth.pixels.begin(), [](float q) {
                   const float steps = q / kInverseDepthStep_per_m + 0.5F;
                   return static_cast<std::uint16_t>(std::min(std::max(steps, 0.0F), 65535.0F));
                 });
  if (finest.intensity.empty()) return view;
  view.intensity.resize(finest.camera.width_px, finest.camera.height_px);
  std::transform(finest.intensity.pixels.begin(), finest.intensity.pixels.end(),
                 view.intensity.pixels.begin(), [](float grey) {
                   return grey < 0.0F ? std::uint8_t{0}
                                      : static_cast<std::uint8_t>(std::clamp(grey + 0.5F, 1.0F, 255.0F));
                 });
  return view;
}

void restore(const StoredView& view, const ViewConfig& config, ViewPyramid& pyramid) {
  pyramid.levels.resize(static_cast<std::size_t>(std::max(config.levels, 1)));
  ViewPyramid::Level& finest = pyramid.levels.front();
  finest.camera = view.camera;
  pyramid.noise = view.noise;
  finest.inverse_depth_per_m.resize(view.camera.width_px, view.camera.height_px);
  std::transform(view.inverse_depth.pixels.begin(), view.inverse_depth.pixels.end(),
                 finest.inverse_depth_per_m.pixels.begin(),
                 [](std::uint16_t steps) { return static_cast<float>(steps) * kInverseDepthStep_per_m; });
  finest.intensity.resize(view.intensity.width, view.intensity.height);
  std::transform(view.intensity.pixels.begin(), view.intensity.pixels.end(), finest.intensity.pixels.begin(),
                 [](std::uint8_t grey) { return grey == 0 ? -1.0F : static_cast<float>(grey); });
  pyramid.grey.resize(0, 0);
  halve_depth(pyramid);
  halve_intensity(pyramid);
}

void improve_depth(ViewPyramid& pyramid, Image<std::uint8_t>& measured, const ViewPyramid& other_view,
                   const Eigen::Isometry3d& T_other_pyramid) {
  const Eigen::Matrix3f R = T_other_pyramid.linear().cast<float>();
  const Eigen::Vector3f t = T_other_pyramid.translation().cast<float>();
  ViewPyramid::Level& own = pyramid.levels.front();
  const ViewPyramid::Level& other = other_view.levels.front();
  const auto fx = static_cast<float>(other.camera.fx_px), fy = static_cast<float>(other.camera.fy_px);
  const auto cx = static_cast<float>(other.camera.cx_px), cy = static_cast<float>(other.camera.cy_px);
  const auto end_u = static_cast<float>(other.camera.width_px - 1),
             end_v = static_cast<float>(other.camera.height_px - 1);
  const Eigen::Vector3f ray_step = R.col(0) / static_cast<float>(own.camera.fx_px);
  for (int y = 0; y < own.camera.height_px; ++y) {
    const Eigen::Vector3f row_ray =
        R * back_project(own.camera, 0.0, static_cast<double>(y), 1.0).cast<float>();
    for (int x = 0; x < own.camera.width_px; ++x) {
      float& q = own.inverse_depth_per_m.at(x, y);
      if (q <= 0.0F) continue;
      // Everything is divided by this view's depth: the point is ray + q t, and its inverse depth in the
      // other view is q / z.
      const Eigen::Vector3f ray = row_ray + static_cast<float>(x) * ray_step;
      const Eigen::Vector3f p = ray + q * t;
      if (p.z() < 0.1F) continue;
      const float u = fx * p.x() / p.z() + cx, v = fy * p.y() / p.z() + cy;
      if (!(u >= 0.0F && v >= 0.0F && u < end_u && v < end_v)) continue;
      const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
      const float* upper = other.inverse_depth_per_m.row(v0) + u0;
      const float* lower = upper + other.camera.width_px;
      const float expected = q / p.z();
      const float gate = 3.0F * depth_sigma_m(pyramid.noise, 1.0F / expected) * expected * expected;
      if (std::abs(upper[0] - expected) > gate || std::abs(upper[1] - expected) > gate ||
          std::abs(lower[0] - expected) > gate || std::abs(lower[1] - expected) > gate) {
        continue;
      }
      const float du = u - static_cast<float>(u0), dv = v - static_cast<float>(v0);
      const float seen = (1.0F - dv) * ((1.0F - du) * upper[0] + du * upper[1]) +
                         dv * ((1.0F - du) * lower[0] + du * lower[1]);
      // q / (ray.z + q t.z) = seen, solved for q.
      const float found = seen * ray.z() / (1.0F - seen * t.z());
      std::uint8_t& n = measured.at(x, y);
      q += (found - q) / static_cast<float>(n + 1);
      if (n < kMostMeasurements) ++n;
    }
  }
}

}  // namespace roomradar
