// rtabmap.hpp: databases of RTAB-Map and of its phone apps.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true for an SQLite database named *.db with RTAB-Map's tables Node, Data and Link.
[[nodiscard]] bool is_rtabmap(const std::filesystem::path& path);

/// Lists the nodes with depth: colour (JPEG or PNG), depth (PNG of 16 bit, mm, or of four bytes per pixel, a
/// float in m), the pose of the robot or phone (12 floats), and the camera's intrinsics and pose on the
/// robot. Poses are those of the optimised graph (Admin.opt_poses) if it is there, else odometry. Sessions
/// (map_id) that no optimised graph joins have world frames of their own: only the longest then has poses.
/// Depth may have fewer pixels than colour, but is registered to it. Stamps are Node.stamp. Nodes are
/// keyframes, often a second apart.
/// @throws Error naming the file if it is damaged, older than version 0.18, or contains no camera or several
///         cameras
/// Source: RTAB-Map, DBDriverSqlite3, CameraModel.
RecordingFacts index_rtabmap(const std::filesystem::path& path);

}  // namespace roomradar
