// camera_rig.hpp: intrinsics and relative pose of a depth and a colour camera, and the files that contain
// them.
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <optional>

#include "mapping/types/frame.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct CameraRig {
  Intrinsics depth_camera;
  /// Intrinsics of the colour camera; unset if there is no colour.
  std::optional<Intrinsics> colour_camera;
  /// Transforms points from the depth camera's frame to the colour camera's frame.
  Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
  /// True if lens and depth errors were removed from the frames before recording.
  bool was_calibrated = false;
  SensorTiming timing = {};     ///< 0 where unknown
  DepthNoise depth_noise = {};  ///< that of a Kinect v1 where unknown
};

/// Reads camera.json:
///   {"format": "roomradar camera", "version": 1,
///    "depth":  {"width_px": 640, "height_px": 480, "fx_px": 585, "fy_px": 585, "cx_px": 320, "cy_px": 240},
///    "colour": {... the same fields; absent if there is no colour},
///    "T_colour_depth": [[r, r, r, tx], [r, r, r, ty], [r, r, r, tz], [0, 0, 0, 1]],       (metres)
///    "timing": {"depth_readout_s": 0.03, "colour_readout_s": 0.026, "colour_delay_s": 0},   (absent if
///    unknown)
///    "depth_noise": {"base_m": 0.0012, "linear": 0, "quadratic_per_m": 0.0019, "from_m": 0.4, "grazing":
///    0.0001},                                        (see DepthNoise; absent: a Kinect v1's)
///    "calibrated": true}                           (absent if frames are as the device delivered them)
/// Throws Error naming the file and a field that is missing, has the wrong type or an invalid value.
CameraRig read_camera_file(const std::filesystem::path& path);
/// Writes camera.json. Throws Error with the file's name if it cannot be written.
void write_camera_file(const CameraRig& rig, const std::filesystem::path& path);

/// Reads camera-intrinsics.txt, the 3 x 3 matrix fx 0 cx / 0 fy cy / 0 0 1. The file does not contain the
/// image size, which callers pass. Throws Error naming the file and the fault if the file is invalid. Also
/// throws Error if the principal point is farther from the image centre than a fifth of the image size. The
/// file then belongs to another image size.
Intrinsics read_intrinsics_matrix(const std::filesystem::path& path, int width_px, int height_px);

/// Returns the rotation nearest to `almost` in the Frobenius norm, computed by SVD. Returns nullopt if
/// `almost` contains a reflection. Also returns nullopt if an entry is not finite, or differs by more than
/// 0.01 from the same entry of the rotation.
std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& almost);

}  // namespace roomradar
