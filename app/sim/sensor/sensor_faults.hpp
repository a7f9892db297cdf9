// sensor_faults.hpp: calibration errors of a simulated Kinect, relative to the cameras its frames declare.
#pragma once
#include <Eigen/Geometry>

#include "app/sim/sensor/sim_options.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/lens.hpp"

namespace roomradar {

/// The true cameras. Errors have the size that calibrations of real Kinects report.
struct SensorFaults {
  Intrinsics depth_camera, colour_camera;
  Lens depth_lens, colour_lens;
  Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
  /// 1 / reported depth = (1 / depth - offset) / scale; see inverse_depth_offset_per_m.
  double inverse_depth_scale = 1.0;
};

/// Returns the faults of one device, always the same, whose frames declare `depth_camera`, `colour_camera`
/// and `T_colour_depth`. Focal lengths are off by about 1 %, principal points by 3 px.
SensorFaults sensor_faults(const Intrinsics& depth_camera, const Intrinsics& colour_camera,
                           const Eigen::Isometry3d& T_colour_depth);

/// Returns the disparity error at a pixel of the depth camera, as 1/m: rings about the centre plus a slope,
/// at most 3 mm at 1 m and 27 mm at 3 m.
double inverse_depth_offset_per_m(const Intrinsics& depth_camera, double x_px, double y_px);

/// Computes, for every pixel of the true camera `truth` with `lens`, where its viewing ray projects in the
/// declared pinhole camera `said`.
using PixelRays = Image<PlanePoint<float>>;
PixelRays pixel_rays(const Intrinsics& truth, const Lens& lens, const Intrinsics& said);

}  // namespace roomradar
