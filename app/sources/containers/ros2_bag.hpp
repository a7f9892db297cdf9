// ros2_bag.hpp: bags of ROS 2, as SQLite databases (.db3) or MCAP files.
#pragma once
#include <filesystem>

#include "app/sources/containers/message_log.hpp"

namespace roomradar {

/// Returns true for an SQLite database named *.db3, an MCAP file, and a folder with metadata.yaml.
[[nodiscard]] bool is_ros2_bag(const std::filesystem::path& path);

/// Opens a bag and lists its messages. A folder's files are the parts of one bag. Messages that are
/// compressed one by one (zstd) are decompressed. Bags that are compressed as a whole (.db3.zstd) are not
/// read.
/// @throws Error naming the file if it is damaged, or compressed as a whole
MessageLog open_ros2_bag(const std::filesystem::path& path);

}  // namespace roomradar
