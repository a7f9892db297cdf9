// ros_bag.hpp: ROS 1 bags, including recordings of RealSense cameras.
#pragma once
#include <filesystem>

#include "app/sources/containers/message_log.hpp"

namespace roomradar {

/// Returns true if the file begins with the signature of ROS 1 bags.
[[nodiscard]] bool is_ros_bag(const std::filesystem::path& path);

/// Opens a bag (format 2.0) and lists its messages from the index records that follow each chunk. A chunk is
/// read only when one of its messages is read. A compressed chunk (bz2, lz4) is then decompressed completely.
/// A truncated bag, as after a killed recorder, is read up to its last complete chunk.
/// @throws Error naming the file if it is not a bag of this version, or contains no complete chunk
/// Source: wiki.ros.org/Bags/Format/2.0.
MessageLog open_ros_bag(const std::filesystem::path& path);

}  // namespace roomradar
