// rolling_shutter.cpp: first-order motion of image points and of their inverse depths.
#include "mapping/alignment/rolling_shutter.hpp"

#include <algorithm>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view_pyramid.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

float between(const float* upper, const float* lower, float du, float dv) {
  return (1.0F - dv) * ((1.0F - du) * upper[0] + du * upper[1]) +
         dv * ((1.0F - du) * lower[0] + du * lower[1]);
}

struct Sample {
  float inverse_depth_per_m, intensity;
};

Sample sample(const Image<float>& inverse_depth_per_m, const Image<float>& intensity, float u, float v) {
  const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
  const float du = u - static_cast<float>(u0), dv = v - static_cast<float>(v0);
  const float* upper = inverse_depth_per_m.row(v0) + u0;
  const float* lower = upper + inverse_depth_per_m.width;
  const int nearest_u = u0 + (du < 0.5F ? 0 : 1), nearest_v = v0 + (dv < 0.5F ? 0 : 1);
  const auto [least, most] = std::minmax({upper[0], upper[1], lower[0], lower[1]});
  const bool one_surface = least > most * (1.0F - kSameSurface);
  Sample found{one_surface ? between(upper, lower, du, dv) : inverse_depth_per_m.at(nearest_u, nearest_v),
               -1.0F};
  if (intensity.empty()) return found;
  const float* upper_grey = intensity.row(v0) + u0;
  const float* lower_grey = upper_grey + intensity.width;
  const bool known = std::min({upper_grey[0], upper_grey[1], lower_grey[0], lower_grey[1]}) >= 0.0F;
  found.intensity =
      one_surface && known ? between(upper_grey, lower_grey, du, dv) : intensity.at(nearest_u, nearest_v);
  return found;
}

}  // namespace

bool gives_velocity(double dt_s) {
  constexpr double kShortest_s = 1e-3, kLongest_s = 0.2;
  return dt_s >= kShortest_s && dt_s <= kLongest_s;
}

CameraVelocity velocity_of(const Eigen::Isometry3d& T_before_after, double dt_s) {
  if (!gives_velocity(dt_s)) return {};
  const Vector6d twist = local(T_before_after) / dt_s;
  if (!twist.allFinite()) return {};
  return {twist.head<3>(), twist.tail<3>()};
}

double image_speed_pxps(const CameraVelocity& velocity, const Intrinsics& camera) {
  return camera.fx_px * (velocity.angular_radps.norm() + velocity.linear_mps.norm());
}

RowMotion row_motion(const Intrinsics& camera, const CameraVelocity& velocity, double readout_s) {
  return {velocity.linear_mps.cast<float>(), velocity.angular_radps.cast<float>(),
          static_cast<float>(readout_s / std::max(camera.height_px, 1)), static_cast<float>(camera.fy_px),
          static_cast<float>(camera.cy_px - 0.5 * (camera.height_px - 1))};
}

void deskew(const Intrinsics& camera, const CameraVelocity& velocity, double readout_s,
            Image<float>& inverse_depth_per_m, Image<float>& intensity) {
  const Image<float> skewed = inverse_depth_per_m, skewed_intensity = intensity;
  const RowMotion motion = row_motion(camera, velocity, readout_s);
  const Eigen::Vector3f &v = motion.linear_mps, &w = motion.angular_radps;
  const auto fx = static_cast<float>(camera.fx_px), fy = motion.fy_px;
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  const auto last_u = static_cast<float>(camera.width_px - 1);
  const auto last_v = static_cast<float>(camera.height_px - 1);
  for (int y = 0; y < camera.height_px; ++y) {
    const float yn = (static_cast<float>(y) - cy) / fy;
    const float rows = static_cast<float>(y) - cy + motion.above_middle_px;
    for (int x = 0; x < camera.width_px; ++x) {
      const std::size_t i = skewed.index(x, y);
      const float q = skewed.pixels[i];
      const float xn = (static_cast<float>(x) - cx) / fx;
      // Per second, a point moves by -(v + w x p) in the camera's frame; all is divided by its depth.
      const float nearing = v.z() * q + w.x() * yn - w.y() * xn;
      const float u_speed = fx * (xn * nearing - v.x() * q - w.y() + w.z() * yn);
      const float v_speed = fy * (yn * nearing - v.y() * q - w.z() * xn + w.x());
      const float t_s = motion.row_s * rows / (1.0F - motion.row_s * v_speed);
      const float u_skewed = static_cast<float>(x) + t_s * u_speed;
      const float v_skewed = static_cast<float>(y) + t_s * v_speed;
      inverse_depth_per_m.pixels[i] = 0.0F;
      if (!intensity.empty()) intensity.pixels[i] = -1.0F;
      if (!(u_skewed >= 0.0F && v_skewed >= 0.0F && u_skewed < last_u && v_skewed < last_v)) continue;
      const Sample seen = sample(skewed, skewed_intensity, u_skewed, v_skewed);
      if (seen.inverse_depth_per_m <= 0.0F) continue;
      const float nearing_seen = v.z() * seen.inverse_depth_per_m + w.x() * yn - w.y() * xn;
      inverse_depth_per_m.pixels[i] = std::max(seen.inverse_depth_per_m * (1.0F - t_s * nearing_seen), 0.0F);
      if (!intensity.empty()) intensity.pixels[i] = seen.intensity;
    }
  }
}

}  // namespace roomradar
