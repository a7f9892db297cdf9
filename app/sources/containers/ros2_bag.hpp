// ros2_bag.hpp: ROS 2 bags: SQLite databases (.db3), MCAP files, and folders of them.
#pragma once
#include <filesystem>

#include "app/sources/containers/message_log.hpp"

namespace roomradar {

/// Returns true for an SQLite database named *.db3, an MCAP file, and a folder with metadata.yaml.
[[nodiscard]] bool is_ros2_bag(const std::filesystem::path& path);

/// Opens a bag and lists its messages. The .db3 and MCAP files of a folder form one bag. Individually
/// compressed messages (zstd) are decompressed. Files compressed as a whole (.db3.zstd) are rejected.
/// @throws Error naming the file if it is damaged, or compressed as a whole
MessageLog open_ros2_bag(const std::filesystem::path& path);

}  // namespace roomradar
