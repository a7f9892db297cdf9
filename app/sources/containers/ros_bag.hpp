// ros_bag.hpp: bags of ROS 1, among them the recordings of RealSense cameras.
#pragma once
#include <filesystem>

#include "app/sources/containers/message_log.hpp"

namespace roomradar {

/// Returns true if the file begins as a bag of ROS 1 does.
[[nodiscard]] bool is_ros_bag(const std::filesystem::path& path);

/// Opens a bag (format 2.0) and lists its messages from the index after each chunk. Chunks are skipped, and
/// read when a message is; compressed ones (bz2, lz4) are decompressed whole. A bag whose recorder was
/// stopped is read up to its last whole chunk.
/// @throws Error naming the file if it is not a bag of this version, or holds no whole chunk
/// Source: wiki.ros.org/Bags/Format/2.0.
MessageLog open_ros_bag(const std::filesystem::path& path);

}  // namespace roomradar
