// ros_bag.hpp: ROS 1 bags, including recordings of RealSense cameras.
#pragma once
#include <filesystem>

#include "app/sources/containers/message_log.hpp"

namespace roomradar {

/// Returns true if the file begins as a bag of ROS 1 does.
[[nodiscard]] bool is_ros_bag(const std::filesystem::path& path);

/// Opens a bag (format 2.0) and lists its messages from the index after each chunk. Chunks are read only when
/// one of their messages is read. A compressed chunk (bz2, lz4) is then decompressed completely. A bag
/// without an end, because its recorder was killed, is read up to its last complete chunk.
/// @throws Error naming the file if it is not a bag of this version, or contains no complete chunk
/// Source: wiki.ros.org/Bags/Format/2.0.
MessageLog open_ros_bag(const std::filesystem::path& path);

}  // namespace roomradar
