// redwood.hpp: recordings of Redwood and Open3D, and of ICL-NUIM.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true if `folder` contains a recording of Redwood or Open3D: depth, color (or colour, image, rgb),
/// and a trajectory (*.log, recognised by its content) or Open3D's intrinsic.json or camera_intrinsic.json.
[[nodiscard]] bool is_redwood(const std::filesystem::path& folder);

/// Lists the frames of a recording of Redwood or Open3D:
///   depth/N.png     mm, or units of 1 / depth_scale m
///   color/N.jpg     or .png; depth is registered to colour
///   *.log           per frame a line of three integers, the first the frame's number, then the 4 x 4 pose,
///                   camera to world (m); a matrix that is no rigid transform means that tracking was lost
///   intrinsic.json  or camera_intrinsic.json: width, height, intrinsic_matrix, and optional depth_scale
///
/// Without a JSON file, the intrinsics are a PrimeSense's, with a focal length of 525 px at a width of 640
/// px. Stamps are N / 30 s.
/// @throws Error naming the file and line if the trajectory or the intrinsics are damaged
RecordingFacts index_redwood(const std::filesystem::path& folder);

/// Returns true if `folder` contains a recording of ICL-NUIM in TUM format: depth, rgb and a trajectory
/// *.gt.freiburg.
[[nodiscard]] bool is_icl_nuim(const std::filesystem::path& folder);

/// Lists the frames of a recording of ICL-NUIM: depth/N.png (1/5000 m), rgb/N.png, and per frame a line
/// `N x y z qx qy qz qw` in *.gt.freiburg. Intrinsics are fx = 481.2 px and fy = -480 px, that is, y points
/// up and the camera frame is left-handed. The reader mirrors camera and world frame in y. Stamps are N / 30
/// s.
/// @throws Error naming the file and line if the trajectory is damaged
RecordingFacts index_icl_nuim(const std::filesystem::path& folder);

}  // namespace roomradar
