// mcap.hpp: MCAP files, a container format of ROS bags.
#pragma once
#include <filesystem>

#include "app/sources/containers/message_log.hpp"

namespace roomradar {

/// Returns true if the file begins with MCAP's magic bytes.
[[nodiscard]] bool is_mcap(const std::filesystem::path& path);

/// Opens an MCAP file and lists its ROS 2 messages (CDR), or its ROS 1 messages if no channel uses CDR. A
/// chunk (uncompressed, lz4 or zstd) with a message index is decompressed only when one of its messages is
/// read. A chunk without a message index is decompressed by this call, to list its messages. A truncated
/// file, as after a killed recorder, is read up to its last complete record.
/// @throws Error naming the file if it is not MCAP, or a chunk is damaged
/// Source: mcap.dev, specification.
MessageLog open_mcap(const std::filesystem::path& path);

}  // namespace roomradar
