// kinect_rig.hpp: cameras and depth conversion from the factory calibration stored in a Kinect.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/kinect_units.hpp"

namespace roomradar {

/// A correspondence between the cameras: the depth camera sees a point at `depth_px`, `depth_m` along its
/// optical axis; the colour camera sees the same point at `colour_px`.
struct SeenByBoth {
  Eigen::Vector2d depth_px;
  double depth_m = 0.0;
  Eigen::Vector2d colour_px;
};

struct KinectConstants {
  KinectZeroPlane zero_plane;
  /// Correspondences, distributed over the image and the depth range.
  std::vector<SeenByBoth> seen_by_both;
};

/// Fits the colour camera to the device's own registration by least squares; keeps `nominal`'s depth camera.
/// Fits the focal length (one for both axes), the principal point, the rotation, and the translation along x.
/// A weak prior pulls each parameter to its nominal value, since the parameters partly compensate for one
/// another. Returns nothing if the RMS error is above 3 px, since the device's constants then have another
/// meaning than assumed.
std::optional<CameraRig> fit_kinect_rig(const std::vector<SeenByBoth>& seen_by_both,
                                        const CameraRig& nominal);

}  // namespace roomradar
