// kinect_units.cpp: converts raw disparity to metres and back, and accelerometer readings to gravity.
#include "app/sources/formats/kinect_units.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomradar {
namespace {

using DepthTable = std::array<float, kRawFarthest + 1>;

const DepthTable& depth_table_m() {
  static const DepthTable table = [] {
    DepthTable depth_m{};
    for (std::size_t raw = 0; raw < depth_m.size(); ++raw)
      depth_m[raw] = static_cast<float>(0.1236 * std::tan(static_cast<double>(raw) / 2842.5 + 1.1863));
    return depth_m;
  }();
  return table;
}

}  // namespace

float raw_depth_m(std::uint16_t raw) { return raw <= kRawFarthest ? depth_table_m()[raw] : 0.0F; }

std::uint16_t raw_from_depth_m(float depth_m) {
  const DepthTable& table = depth_table_m();
  const float first_step_m = table[1] - table[0];
  const float last_step_m = table[kRawFarthest] - table[kRawFarthest - 1];
  if (!(depth_m >= table.front() - first_step_m / 2 && depth_m <= table.back() + last_step_m / 2))
    return kRawNoDepth;
  const auto above = std::lower_bound(table.begin(), table.end(), depth_m);
  if (above == table.begin()) return 0;
  if (above == table.end()) return kRawFarthest;
  const auto nearest = *above - depth_m < depth_m - *(above - 1) ? above : above - 1;
  return static_cast<std::uint16_t>(nearest - table.begin());
}

float raw_depth_m(std::uint16_t raw, const KinectZeroPlane& zero_plane) {
  constexpr double kSubPixels = 4.0;  // raw steps per column
  constexpr double kOffset_px = 0.375;
  constexpr double kNearest_m = 0.2, kFarthest_m = 10.0;
  if (raw >= kRawNoDepth) return 0.0F;
  const double shift_cm = (raw / kSubPixels - zero_plane.const_shift_px - kOffset_px) * zero_plane.pixel_cm;
  const double depth_m = 0.01 * (shift_cm * zero_plane.distance_cm / (zero_plane.emitter_cm - shift_cm) +
                                 zero_plane.distance_cm);
  return depth_m >= kNearest_m && depth_m <= kFarthest_m ? static_cast<float>(depth_m) : 0.0F;
}

std::optional<Eigen::Vector3d> down_from_acceleration(const Eigen::Vector3d& acceleration_g) {
  const double magnitude_g = acceleration_g.norm();
  if (!(magnitude_g >= 0.8 && magnitude_g <= 1.2)) return std::nullopt;
  return Eigen::Vector3d(acceleration_g.x(), acceleration_g.y(), -acceleration_g.z()) / magnitude_g;
}

Eigen::Vector3d acceleration_at_rest_g(const Eigen::Vector3d& down_camera) {
  return {down_camera.x(), down_camera.y(), -down_camera.z()};
}

}  // namespace roomradar
