// kinect_units.hpp: converts a Kinect v1's raw values to metres, seconds and directions.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>

namespace roomradar {

/// Raw value of a pixel without depth.
constexpr std::uint16_t kRawNoDepth = 2047;
/// Clock rate of the images' 32 bit timestamps, which wrap after 71.6 s.
constexpr double kKinectTicksPerSecond = 60e6;
/// Accelerometer scale (KXSD9 data sheet; libfreenect.h).
constexpr double kKinectCountsPerG = 819.0;
/// Magnitude of 1 g.
constexpr double kStandardGravity_m_s2 = 9.80665;
/// Max valid raw value, 9.78 m. Above it, one raw step is more than 0.27 m.
constexpr std::uint16_t kRawFarthest = 1057;

/// Converts a raw 11 bit disparity to depth along the optical axis, m: 0.1236 tan(raw / 2842.5 + 1.1863).
/// Depth increases with `raw` from 0.31 m at 0 to 9.78 m at 1057. Above 1057, the result is 0 (invalid).
/// Source: Stephane Magnenat's fit, OpenKinect wiki, "Imaging Information". Nicolas Burrus' formula, 1 /
/// (3.331 - 0.003071 raw), is also common. In our test recordings, with the cameras of nominal_rig.cpp,
/// Burrus' formula gives 94 to 95 degrees between two perpendicular concrete walls. Magnenat's formula gives
/// 89 to 90 degrees and flatter walls.
float raw_depth_m(std::uint16_t raw);

/// Returns the raw disparity whose depth is nearest to depth_m. Returns kRawNoDepth for depth 0, and for
/// depths outside the range by more than half a raw step. Inverse of raw_depth_m() for raw <= kRawFarthest.
std::uint16_t raw_from_depth_m(float depth_m);

/// Factory calibration of a Kinect's depth measurement. Lengths are in centimetres, as the device stores
/// them.
struct KinectZeroPlane {
  /// Depth of the reference plane, at which the disparity is const_shift_px.
  double distance_cm = 120.0;
  /// Width of one of the camera's 1280 pixel columns, measured on the reference plane.
  double pixel_cm = 0.1042;
  /// Baseline from the depth camera to the projector.
  double emitter_cm = 7.5;
  /// Disparity at the reference plane.
  double const_shift_px = 200.0;
};

/// Converts a raw 11 bit disparity to depth (m) with the device's factory calibration. Returns 0 if the
/// disparity is invalid or the depth outside 0.2 to 10 m. Source: libfreenect, registration.c,
/// freenect_raw_to_mm, without its rounding to millimetres.
float raw_depth_m(std::uint16_t raw, const KinectZeroPlane& zero_plane);

/// Computes the unit direction of gravity in the depth camera's frame (x right, y down, z forward) from an
/// accelerometer reading in g. The accelerometer's axes are x left, y up, z forward. At rest, the
/// accelerometer measures the support force, opposite to gravity. The result is therefore (x, y, -z),
/// normalised. Returns nullopt if the magnitude is outside 0.8 to 1.2 g. The device then accelerates or has
/// no reading.
std::optional<Eigen::Vector3d> down_from_acceleration(const Eigen::Vector3d& acceleration_g);

/// Returns the accelerometer reading (g) at rest for a direction of gravity. Inverse of
/// down_from_acceleration().
Eigen::Vector3d acceleration_at_rest_g(const Eigen::Vector3d& down_camera);

/// Converts the device's timestamps, which wrap, to seconds. Successive stamps must be less than 35 s apart.
/// Depth and colour images share one clock. Pass the stamps of both to the same object, in order of arrival.
/// The device's clock is reset when the device is unplugged; see restart().
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
  /// Sets the time of the next stamp to at_s, whatever the stamp's value.
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
