// sensor_faults.hpp: calibration errors of a simulated Kinect, i.e. differences between its true cameras and
// the cameras that its frames declare.
#pragma once
#include <Eigen/Geometry>

#include "app/sim/sensor/sim_options.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/lens.hpp"

namespace roomradar {

/// Parameters of the true cameras. They differ from the declared parameters by as much as calibrations of
/// real Kinects report.
struct SensorFaults {
  Intrinsics depth_camera, colour_camera;
  Lens depth_lens, colour_lens;
  Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
  /// `scale` in 1 / reported depth = (1 / true depth - offset) / scale, where offset is
  /// inverse_depth_offset_per_m().
  double inverse_depth_scale = 1.0;
};

/// Returns the true cameras of a simulated device whose frames declare `depth_camera`, `colour_camera` and
/// `T_colour_depth`. The differences are constant, about 1 % in focal lengths and 3 px in principal points at
/// 640 px width.
SensorFaults sensor_faults(const Intrinsics& depth_camera, const Intrinsics& colour_camera,
                           const Eigen::Isometry3d& T_colour_depth);

/// Returns the disparity error at a pixel of the depth camera, as inverse depth, 1/m. The error consists of
/// rings about the image centre plus a linear slope. It corresponds to at most 3 mm at 1 m and 27 mm at 3 m.
double inverse_depth_offset_per_m(const Intrinsics& depth_camera, double x_px, double y_px);

/// Pixel coordinates at which each viewing ray of the true camera projects into the declared pinhole camera's
/// image. One entry per pixel of the true camera.
using PixelRays = Image<PlanePoint<float>>;
/// Computes the PixelRays of the true camera `truth` with this lens, for the declared pinhole camera `said`.
PixelRays pixel_rays(const Intrinsics& truth, const Lens& lens, const Intrinsics& said);

}  // namespace roomradar
