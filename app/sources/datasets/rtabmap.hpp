// rtabmap.hpp: databases of RTAB-Map, also of its apps for phones.
#pragma once
#include <filesystem>

#include "app/sources/datasets/indexed_source.hpp"

namespace roomradar {

/// Returns true for an SQLite database named *.db with RTAB-Map's tables Node, Data and Link.
[[nodiscard]] bool is_rtabmap(const std::filesystem::path& path);

/// Lists the nodes with depth: a JPEG or PNG, depth as PNG (16 bit, mm; or four bytes, a float in m), the
/// pose of the robot or phone as odometry estimated it (12 floats), and the camera with its pose on the
/// robot. Depth may be smaller than colour; both are of one camera. Stamps are Node.stamp. Nodes are key
/// frames, often a second apart.
/// @throws Error naming the file if it is damaged, older than version 0.18, or holds no or several cameras
/// Source: RTAB-Map, DBDriverSqlite3, CameraModel.
IndexedRecording index_rtabmap(const std::filesystem::path& path);

}  // namespace roomradar
