// sensor_faults.hpp: how a simulated Kinect that nobody calibrated differs from what its frames say of it.
#pragma once
#include <Eigen/Geometry>

#include "app/sim/sensor/sim_options.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/lens.hpp"

namespace roomradar {

/// The cameras as they are. Figures of the size that calibrations of real Kinects report.
struct SensorFaults {
  Intrinsics depth_camera, colour_camera;
  Lens depth_lens, colour_lens;
  Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
  /// 1 / reported depth = (1 / depth - offset) / scale; see inverse_depth_offset_per_m.
  double inverse_depth_scale = 1.0;
};

/// The faults of one device, which is always the same, for cameras whose frames say `depth_camera`,
/// `colour_camera` and `T_colour_depth`. Focal lengths are off by about 1 %, principal points by 3 px.
SensorFaults sensor_faults(const Intrinsics& depth_camera, const Intrinsics& colour_camera,
                           const Eigen::Isometry3d& T_colour_depth);

/// What disparity is off by at a pixel of the depth camera, as 1/m: rings about the middle and a slope, at
/// most 3 mm at 1 m and 27 mm at 3 m.
double inverse_depth_offset_per_m(const Intrinsics& depth_camera, double x_px, double y_px);

/// For every pixel of a camera that is really `truth` with `lens`, the image coordinates at which the pinhole
/// camera `said` shows what it sees.
using PixelRays = Image<PlanePoint<float>>;
PixelRays pixel_rays(const Intrinsics& truth, const Lens& lens, const Intrinsics& said);

}  // namespace roomradar
