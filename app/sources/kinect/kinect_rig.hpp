// kinect_rig.hpp: cameras and depth conversion from a Kinect's stored factory calibration.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/kinect_units.hpp"

namespace roomradar {

/// A correspondence between the cameras. The depth camera sees a point at pixel `depth_px` with depth
/// `depth_m`. The colour camera sees the same point at pixel `colour_px`.
struct SeenByBoth {
  Eigen::Vector2d depth_px;
  double depth_m = 0.0;
  Eigen::Vector2d colour_px;
};

/// Factory calibration stored in a Kinect.
struct KinectConstants {
  KinectZeroPlane zero_plane;
  /// Correspondences of the device's registration, distributed over the image and the depth range.
  std::vector<SeenByBoth> seen_by_both;
};

/// Fits the colour camera to correspondences of the device's registration by least squares. The depth camera
/// is that of `nominal`. Parameters are one focal length for both axes, the principal point, the rotation,
/// and the translation along x. The parameters partly compensate for each other. A weak prior therefore pulls
/// each of them towards its value in `nominal`. Returns nullopt for fewer than 50 correspondences, without a
/// nominal colour camera, and if the RMS error is above 3 px. A larger error means that the calibration data
/// do not have the assumed layout.
std::optional<CameraRig> fit_kinect_rig(const std::vector<SeenByBoth>& seen_by_both,
                                        const CameraRig& nominal);

}  // namespace roomradar
