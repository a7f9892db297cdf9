// kinect_units.hpp: what a Kinect v1 delivers, in metres, seconds and directions; none else knows its units.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace roomradar {

constexpr std::uint16_t kRawNoDepth = 2047;
/// Of the 32 bit stamps on its images; they wrap after 71.6 s.
constexpr double kKinectTicksPerSecond = 60e6;
constexpr double kKinectCountsPerG = 819.0;   ///< of its accelerometer (KXSD9 data sheet; libfreenect.h)
constexpr std::uint16_t kRawFarthest = 1057;  ///< 9.88 m; past it one raw step is more than 0.5 m

/// Depth (m) along the optical axis of a raw 11 bit disparity: 0.1236 tan(raw / 2842.5 + 1.1863).
/// Grows with raw from 0.31 m at 0 to 9.88 m at 1057; 0 (nothing measured) above.
/// Source: Stephane Magnenat's fit, OpenKinect wiki, "Imaging Information". The other formula in use, Nicolas
/// Burrus' 1 / (3.331 - 0.003071 raw), makes 94 to 95 degrees of the corner of two concrete walls in the
/// recordings that this was tried on, with the cameras of nominal_rig.cpp; this one makes 89 to 90, and
/// flatter walls.
float raw_depth_m(std::uint16_t raw);

/// The raw disparity whose depth is nearest; kRawNoDepth for 0 and for what lies more than half a step
/// outside the range. raw_from_depth_m(raw_depth_m(raw)) == raw for raw <= kRawFarthest.
std::uint16_t raw_from_depth_m(float depth_m);

/// Unit direction of gravity in the depth camera's frame (x right, y down, z forward) from what the
/// accelerometer measures (the unit does not matter to the direction; give g). Its axes are x left, y up, z
/// forward, and at rest it measures the push of the table against gravity: down = (x, y, -z). Nothing if the
/// magnitude is not within 0.8 .. 1.2 g: then the device is being moved, or nothing was measured.
std::optional<Eigen::Vector3d> down_from_acceleration(const Eigen::Vector3d& acceleration_g);

/// The reading of an accelerometer at rest under that gravity; the inverse of the above.
Eigen::Vector3d acceleration_at_rest_g(const Eigen::Vector3d& down_camera);

/// Makes seconds of the device's wrapping stamps. Neighbouring stamps must be less than 35 s apart; depth and
/// colour run by the same clock and go through one object in the order of their arrival.
class KinectClock {
 public:
  double seconds(std::uint32_t ticks) {
    if (!last_ticks_)
      total_ticks_ = ticks;
    else
      total_ticks_ += static_cast<std::int32_t>(ticks - *last_ticks_);
    last_ticks_ = ticks;
    return static_cast<double>(total_ticks_) / kKinectTicksPerSecond;
  }

 private:
  std::optional<std::uint32_t> last_ticks_;
  std::int64_t total_ticks_ = 0;
};

}  // namespace roomradar
