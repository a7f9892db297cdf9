// sensor_faults.cpp: the true parameters of one simulated Kinect.
#include "app/sim/sensor/sensor_faults.hpp"

#include <cmath>

namespace roomradar {
namespace {

Intrinsics off_by(const Intrinsics& camera, double focal_factor, double right_px, double down_px) {
  Intrinsics off = camera;
  off.fx_px *= focal_factor;
  off.fy_px *= focal_factor * 1.001;
  off.cx_px += right_px * camera.width_px / 640.0;
  off.cy_px += down_px * camera.width_px / 640.0;
  return off;
}

}  // namespace

SensorFaults sensor_faults(const Intrinsics& depth_camera, const Intrinsics& colour_camera,
                           const Eigen::Isometry3d& T_colour_depth) {
  SensorFaults faults;
  faults.depth_camera = off_by(depth_camera, 1.008, -3.0, 2.0);
  faults.colour_camera = off_by(colour_camera, 0.988, 3.5, -2.5);
  faults.depth_lens = {-0.06, 0.12, 0.0006, -0.0005, 0.0};
  faults.colour_lens = {0.11, -0.22, -0.0008, 0.0011, 0.04};
  faults.T_colour_depth = T_colour_depth;
  faults.T_colour_depth.translate(Eigen::Vector3d(0.0015, -0.001, 0.002));
  faults.T_colour_depth.rotate(Eigen::AngleAxisd(0.008, Eigen::Vector3d(0.4, -0.8, 0.45).normalized()));
  faults.inverse_depth_scale = 1.006;
  return faults;
}

double inverse_depth_offset_per_m(const Intrinsics& depth_camera, double x_px, double y_px) {
  const double x = (x_px - 0.5 * depth_camera.width_px) / depth_camera.width_px;
  const double y = (y_px - 0.5 * depth_camera.height_px) / depth_camera.width_px;
  return 0.0018 * std::cos(9.0 * std::hypot(x, y)) + 0.0016 * x - 0.0008 * y;
}

PixelRays pixel_rays(const Intrinsics& truth, const Lens& lens, const Intrinsics& said) {
  PixelRays rays(truth.width_px, truth.height_px);
  for (int y = 0; y < rays.height; ++y)
    for (int x = 0; x < rays.width; ++x) {
      const PlanePoint<double> p =
          undistorted({(x - truth.cx_px) / truth.fx_px, (y - truth.cy_px) / truth.fy_px}, lens);
      rays.at(x, y) = {static_cast<float>(said.fx_px * p.x + said.cx_px),
                       static_cast<float>(said.fy_px * p.y + said.cy_px)};
    }
  return rays;
}

}  // namespace roomradar
