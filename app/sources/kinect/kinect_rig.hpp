// kinect_rig.hpp: cameras and depth conversion from the factory calibration stored in a Kinect.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/kinect_units.hpp"

namespace roomradar {

/// A correspondence: the depth camera sees a point at `depth_px`, `depth_m` along its axis; the colour camera
/// sees the same point at `colour_px`.
struct SeenByBoth {
  Eigen::Vector2d depth_px;
  double depth_m = 0.0;
  Eigen::Vector2d colour_px;
};

struct KinectConstants {
  KinectZeroPlane zero_plane;
  std::vector<SeenByBoth> seen_by_both;  ///< spread over the image and the depth range
};

/// Fits the colour camera to the device's own registration by least squares; `nominal`'s depth camera is
/// kept. Fitted are the focal length (one for both axes), principal point, rotation, and shift along x. A
/// weak prior pulls each to its nominal value, since they partly compensate for one another. Returns nothing
/// if the RMS error is above 3 px: the constants then do not mean what is assumed.
std::optional<CameraRig> fit_kinect_rig(const std::vector<SeenByBoth>& seen_by_both,
                                        const CameraRig& nominal);

}  // namespace roomradar
