// kinect_units.hpp: what a Kinect v1 delivers, in metres, seconds and directions; none else knows its units.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>

namespace roomradar {

constexpr std::uint16_t kRawNoDepth = 2047;
/// Of the 32 bit stamps on its images; they wrap after 71.6 s.
constexpr double kKinectTicksPerSecond = 60e6;
constexpr double kKinectCountsPerG = 819.0;        ///< of its accelerometer (KXSD9 data sheet; libfreenect.h)
constexpr double kStandardGravity_m_s2 = 9.80665;  ///< 1 g
constexpr std::uint16_t kRawFarthest = 1057;       ///< 9.88 m; past it one raw step is more than 0.5 m

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

/// What a Kinect's factory stored of how it measures depth. All lengths in the same unit as the device gives
/// them: centimetres.
struct KinectZeroPlane {
  double distance_cm = 120.0;  ///< from the depth camera, where the disparity is const_shift_px
  double pixel_cm = 0.1042;    ///< of the camera's 1280 columns, there
  double emitter_cm = 7.5;     ///< from the depth camera to the projector
  double const_shift_px = 200.0;
};

/// Depth (m) of a raw 11 bit disparity by the device's own constants; 0 where there is none, or none within
/// 0.2 .. 10 m. Source: libfreenect, registration.c, freenect_raw_to_mm, without its rounding to millimetres.
float raw_depth_m(std::uint16_t raw, const KinectZeroPlane& zero_plane);

/// Unit direction of gravity in the depth camera's frame (x right, y down, z forward) from what the
/// accelerometer measures (the unit does not matter to the direction; give g). Its axes are x left, y up, z
/// forward, and at rest it measures the push of the table against gravity: down = (x, y, -z). Nothing if the
/// magnitude is not within 0.8 .. 1.2 g: then the device is being moved, or nothing was measured.
std::optional<Eigen::Vector3d> down_from_acceleration(const Eigen::Vector3d& acceleration_g);

/// The reading of an accelerometer at rest under that gravity; the inverse of the above.
Eigen::Vector3d acceleration_at_rest_g(const Eigen::Vector3d& down_camera);

/// Makes seconds of the device's wrapping stamps. Neighbouring stamps must be less than 35 s apart; depth and
/// colour run by the same clock and go through one object in the order of their arrival. The clock of a
/// device that was plugged in anew begins anew, too.
class KinectClock {
 public:
  double seconds(std::uint32_t ticks) {
    if (!last_ticks_)
      total_ticks_ = restart_ticks_.value_or(ticks);
    else
      total_ticks_ += static_cast<std::int32_t>(ticks - *last_ticks_);
    last_ticks_ = ticks;
    return static_cast<double>(total_ticks_) / kKinectTicksPerSecond;
  }
  /// The next stamp, whatever it is, means `at_s`.
  void restart(double at_s) {
    last_ticks_.reset();
    restart_ticks_ = std::llround(at_s * kKinectTicksPerSecond);
  }

 private:
  std::optional<std::uint32_t> last_ticks_;
  std::optional<std::int64_t> restart_ticks_;
  std::int64_t total_ticks_ = 0;
};

}  // namespace roomradar
