// stray_scanner.hpp: recordings of an iPhone or iPad with LiDAR by Stray Scanner.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true if `folder` contains a recording by Stray Scanner: odometry.csv, camera_matrix.csv and depth.
[[nodiscard]] bool is_stray_scanner(const std::filesystem::path& folder);

/// Lists the frames of a recording by Stray Scanner:
///   depth/000000.png       depth, mm
///   confidence/000000.png  0, 1 or 2; depth of confidence 0 is set to 0 (invalid)
///   rgb.mp4                colour; frame N is the video's frame N. Without it, frames have no colour
///   camera_matrix.csv      3 x 3 intrinsics for the video's size; depth has the same camera, scaled
///   odometry.csv           timestamp (s), frame, x, y, z (m), qx, qy, qz, qw: camera to world
///
/// The recorded camera's axes are roomradar's. The recorded world frame has y up and is converted to z up.
/// Gravity follows from the poses, since ARKit aligns its world frame with gravity. imu.csv is not read.
/// Lines of odometry.csv that are cut short are left out. Depth images without a line have no pose.
/// @throws Error naming the file if camera_matrix.csv is not a 3 x 3 matrix, or no depth image can be read
RecordingFacts index_stray_scanner(const std::filesystem::path& folder);

}  // namespace roomradar
