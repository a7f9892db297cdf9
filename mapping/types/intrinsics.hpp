// intrinsics.hpp: the pinhole camera and its coordinate frame.
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace roomradar {

/// Pinhole camera without distortion. Camera frame: x right, y down, z forward (OpenCV convention). The
/// centre of pixel (0, 0) is at image coordinates (0, 0): u = fx * x / z + cx.
struct Intrinsics {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  friend bool operator==(const Intrinsics&, const Intrinsics&) = default;
};

/// Returns the point in the camera frame, m, at image coordinates (u, v) and depth_m along the optical axis.
inline Eigen::Vector3d back_project(const Intrinsics& camera, double u_px, double v_px, double depth_m) {
  return {(u_px - camera.cx_px) / camera.fx_px * depth_m, (v_px - camera.cy_px) / camera.fy_px * depth_m,
          depth_m};
}

/// Returns the image coordinates (u, v) of a point in the camera frame. The point's z must be > 0.
inline Eigen::Vector2d project(const Intrinsics& camera, const Eigen::Vector3d& p_camera) {
  return {camera.fx_px * p_camera.x() / p_camera.z() + camera.cx_px,
          camera.fy_px * p_camera.y() / p_camera.z() + camera.cy_px};
}

/// Returns the camera with its image scaled by `factor` (0.5: half the width and height, rounded down). Pixel
/// centres are at integer coordinates, so cx' = (cx + 0.5) * factor - 0.5.
inline Intrinsics scaled(const Intrinsics& camera, double factor) {
  return {static_cast<int>(std::floor(camera.width_px * factor)),
          static_cast<int>(std::floor(camera.height_px * factor)),
          camera.fx_px * factor,
          camera.fy_px * factor,
          (camera.cx_px + 0.5) * factor - 0.5,
          (camera.cy_px + 0.5) * factor - 0.5};
}

/// Throws Error naming `where`, the field and the rule if the camera is invalid. A valid camera has sizes in
/// 1..16384 and finite focal lengths > 0. Its principal point is finite and within one image size of the
/// image.
void require_valid(const Intrinsics& camera, const char* where);

}  // namespace roomradar
