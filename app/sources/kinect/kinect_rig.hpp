// kinect_rig.hpp: what the factory measured of one Kinect and stored in it, as cameras and metres.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/kinect_units.hpp"

namespace roomradar {

/// A point that the depth camera sees at `depth_px`, `depth_m` away along its axis, and the colour camera at
/// `colour_px`.
struct SeenByBoth {
  Eigen::Vector2d depth_px;
  double depth_m = 0.0;
  Eigen::Vector2d colour_px;
};

struct KinectConstants {
  KinectZeroPlane zero_plane;
  std::vector<SeenByBoth> seen_by_both;  ///< all over the image and the range of depths
};

/// The rig in which the colour camera sees what the device's own registration says it sees: `nominal`'s depth
/// camera is kept, and its colour camera's focal length (one for both axes), principal point, rotation and
/// shift along x fitted by least squares; each is drawn weakly to its nominal value, since they can stand in
/// for each other in part. Nothing if the fit is off by more than 3 px (root of the mean square): then the
/// constants are not what they are taken for.
std::optional<CameraRig> fit_kinect_rig(const std::vector<SeenByBoth>& seen_by_both,
                                        const CameraRig& nominal);

}  // namespace roomradar
