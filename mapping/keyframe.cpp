// keyframe.cpp: a view that later ones are aligned with, its depth made better by what follows.
#include "mapping/keyframe.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/depth_noise.hpp"

namespace roomradar {
namespace {

constexpr int kMostMeasurements = 60;  // then the mean goes on as a moving one

}  // namespace

Keyframe make_keyframe(std::int64_t frame_index, const ViewPyramid& pyramid,
                       const Eigen::Isometry3d& T_world_camera, const ViewConfig& config) {
  Keyframe keyframe;
  keyframe.frame_index = frame_index;
  keyframe.pyramid.levels = pyramid.levels;
  const Intrinsics& camera = pyramid.levels.front().camera;
  keyframe.measured.resize(camera.width_px, camera.height_px, 1);
  make_reference(keyframe.pyramid, T_world_camera, config, keyframe.reference);
  return keyframe;
}

void improve_depth(Keyframe& keyframe, const ViewPyramid& view, const Eigen::Isometry3d& T_world_view) {
  const Eigen::Isometry3d T_view_keyframe = T_world_view.inverse() * keyframe.reference.T_world_view;
  const Eigen::Matrix3f R = T_view_keyframe.linear().cast<float>();
  const Eigen::Vector3f t = T_view_keyframe.translation().cast<float>();
  ViewPyramid::Level& own = keyframe.pyramid.levels.front();
  const ViewPyramid::Level& other = view.levels.front();
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
      // Everything is divided by the keyframe's depth: the point is ray + q t, and its inverse depth there q
      // / z.
      const Eigen::Vector3f ray = row_ray + static_cast<float>(x) * ray_step;
      const Eigen::Vector3f p = ray + q * t;
      if (p.z() < 0.1F) continue;
      const float u = fx * p.x() / p.z() + cx, v = fy * p.y() / p.z() + cy;
      if (!(u >= 0.0F && v >= 0.0F && u < end_u && v < end_v)) continue;
      const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
      const float* upper = other.inverse_depth_per_m.row(v0) + u0;
      const float* lower = upper + other.camera.width_px;
      const float expected = q / p.z();
      const float gate = 3.0F * depth_sigma_m(1.0F / expected) * expected * expected;
      if (std::abs(upper[0] - expected) > gate || std::abs(upper[1] - expected) > gate ||
          std::abs(lower[0] - expected) > gate || std::abs(lower[1] - expected) > gate) {
        continue;
      }
      const float du = u - static_cast<float>(u0), dv = v - static_cast<float>(v0);
      const float seen = (1.0F - dv) * ((1.0F - du) * upper[0] + du * upper[1]) +
                         dv * ((1.0F - du) * lower[0] + du * lower[1]);
      // q / (ray.z + q t.z) = seen, solved for q.
      const float measured = seen * ray.z() / (1.0F - seen * t.z());
      std::uint8_t& n = keyframe.measured.at(x, y);
      q += (measured - q) / static_cast<float>(n + 1);
      if (n < kMostMeasurements) ++n;
    }
  }
  ++keyframe.improved_since_refresh;
}

void refresh(Keyframe& keyframe, const ViewConfig& config) {
  halve_depth(keyframe.pyramid);
  make_reference(keyframe.pyramid, Eigen::Isometry3d(keyframe.reference.T_world_view), config,
                 keyframe.reference);
  keyframe.improved_since_refresh = 0;
}

}  // namespace roomradar
