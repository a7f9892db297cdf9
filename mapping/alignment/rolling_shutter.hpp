// rolling_shutter.hpp: rolling-shutter model: motion of a camera while its image is read row by row.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Velocity of the depth camera in its own frame, at the middle of the depth image's readout.
struct CameraVelocity {
  Eigen::Vector3d linear_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_radps = Eigen::Vector3d::Zero();
};

/// Returns true if dt_s is in 1 ms to 0.2 s. A motion over any other time gives no usable velocity.
bool gives_velocity(double dt_s);
/// Returns the constant velocity of a camera that moves by T_before_after in dt_s. Returns 0 if
/// gives_velocity(dt_s) is false or the motion is not finite.
CameraVelocity velocity_of(const Eigen::Isometry3d& T_before_after, double dt_s);

/// Returns an upper bound of the image speed of points at a depth of 1 m near the image's centre, px/s.
double image_speed_pxps(const CameraVelocity& velocity, const Intrinsics& camera);

/// Motion of the points of an image during its readout. Row middle_px is read at the middle of the readout.
/// Between that time and the readout of row y, a point moves by (y - middle_px) * row_s * (linear + angular x
/// point).
struct RowMotion {
  Eigen::Vector3f linear_mps = Eigen::Vector3f::Zero();
  Eigen::Vector3f angular_radps = Eigen::Vector3f::Zero();
  float row_s = 0.0F;  ///< time from one row to the next; 0: the points do not move
  float fy_px = 0.0F;
  float above_middle_px = 0.0F;  ///< cy - middle_px

  /// Returns the point's coordinates in the camera frame at the middle of the readout. The point's z must be
  /// > 0.
  [[nodiscard]] Eigen::Vector3f at_middle(const Eigen::Vector3f& p_camera) const {
    if (row_s == 0.0F) return p_camera;
    const float t_s = row_s * (fy_px * p_camera.y() / p_camera.z() + above_middle_px);
    return p_camera + t_s * (linear_mps + angular_radps.cross(p_camera));
  }
};
RowMotion row_motion(const Intrinsics& camera, const CameraVelocity& velocity, double readout_s);

/// Moves depths and intensities to the pixels at which a global shutter would have seen them at the middle of
/// the readout, and changes the depths accordingly. Interpolates between pixels of one surface; elsewhere
/// takes the nearest pixel's value. Uses a first-order model of the motion: at 90 degrees/s and 30 ms of
/// readout, the error is 0.2 px in an image 640 px wide.
/// @param[in,out] inverse_depth_per_m  1/m; 0: no depth
/// @param[in,out] intensity            -1: unknown; may be empty
/// Source: Ringaby and Forssen, Scan Rectification for Structured Light Range Sensors with Rolling Shutters,
/// ICCV 2011.
void deskew(const Intrinsics& camera, const CameraVelocity& velocity, double readout_s,
            Image<float>& inverse_depth_per_m, Image<float>& intensity);

}  // namespace roomradar
