// sensor_faults.hpp: calibration errors of a simulated Kinect: its true cameras differ from the cameras that
// its frames declare.
#pragma once
#include <Eigen/Geometry>

#include "app/sim/sensor/sim_options.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/lens.hpp"

namespace roomradar {

/// The true cameras. The errors have the size that calibrations of real Kinects report.
struct SensorFaults {
  Intrinsics depth_camera, colour_camera;
  Lens depth_lens, colour_lens;
  Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
  /// `scale` in: 1 / reported depth = (1 / true depth - offset) / scale, with inverse_depth_offset_per_m() as
  /// offset.
  double inverse_depth_scale = 1.0;
};

/// Returns the true cameras of one simulated device, always the same, whose frames declare `depth_camera`,
/// `colour_camera` and `T_colour_depth`. Focal lengths differ by about 1 %, principal points by 3 px.
SensorFaults sensor_faults(const Intrinsics& depth_camera, const Intrinsics& colour_camera,
                           const Eigen::Isometry3d& T_colour_depth);

/// Returns the disparity error at a pixel of the depth camera, as inverse depth, 1/m. It consists of rings
/// about the centre and a slope: at most 3 mm at 1 m and 27 mm at 3 m.
double inverse_depth_offset_per_m(const Intrinsics& depth_camera, double x_px, double y_px);

/// Per pixel of the true camera: the point in the declared pinhole camera's image to which the pixel's
/// viewing ray projects.
using PixelRays = Image<PlanePoint<float>>;
/// Computes the rays of a camera.
/// @param truth  true camera
/// @param lens   lens of the true camera
/// @param said   declared pinhole camera
PixelRays pixel_rays(const Intrinsics& truth, const Lens& lens, const Intrinsics& said);

}  // namespace roomradar
