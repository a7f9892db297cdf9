// camera_rig.hpp: the depth camera, the colour camera beside it, and their file in a recording.
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <optional>

#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct CameraRig {
  Intrinsics depth_camera;
  std::optional<Intrinsics> colour_camera;  ///< nothing where there is no colour
  /// Depth-camera points to colour-camera points.
  Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
  /// The recording's frames were freed of lens and depth errors before they were recorded.
  bool was_calibrated = false;
};

/// camera.json:
///   {"format": "roomradar camera", "version": 1,
///    "depth":  {"width_px": 640, "height_px": 480, "fx_px": 585, "fy_px": 585, "cx_px": 320, "cy_px": 240},
///    "colour": {... the same fields; left out where there is no colour},
///    "T_colour_depth": [[r, r, r, tx], [r, r, r, ty], [r, r, r, tz], [0, 0, 0, 1]],       (metres)
///    "calibrated": true}                           (left out where frames are as the device gave them)
/// Throws Error naming the file, and the field where one is missing, of the wrong type or impossible.
CameraRig read_camera_file(const std::filesystem::path& path);
void write_camera_file(const CameraRig& rig, const std::filesystem::path& path);

/// camera-intrinsics.txt: the 3 x 3 matrix fx 0 cx / 0 fy cy / 0 0 1 of a camera whose images are of the size
/// given. The file does not say its size, so a principal point farther than a fifth of the image from the
/// image's centre is taken as a sign that it belongs to other images. Throws Error naming the file and what
/// is wrong with it.
Intrinsics read_intrinsics_matrix(const std::filesystem::path& path, int width_px, int height_px);

/// The rotation nearest to `almost` (Frobenius norm, by SVD), or nothing if it has an entry that is not
/// finite, is farther than 0.01 in any entry from it, or mirrors.
std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& almost);

}  // namespace roomradar
