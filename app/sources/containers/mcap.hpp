// mcap.hpp: MCAP files, a form of ROS 2's bags.
#pragma once
#include <filesystem>

#include "app/sources/containers/message_log.hpp"

namespace roomradar {

/// Returns true if the file begins as an MCAP file does.
[[nodiscard]] bool is_mcap(const std::filesystem::path& path);

/// Opens an MCAP file and lists its messages of ROS 2 (CDR), or of ROS 1 if it holds none of ROS 2. Chunks
/// (none, lz4, zstd) with a message index are skipped, and decompressed when a message in them is read.
/// Chunks without one are decompressed to list them. A file whose recorder was stopped is read up to its last
/// whole record.
/// @throws Error naming the file if it is not MCAP, or a chunk is damaged
/// Source: mcap.dev, specification.
MessageLog open_mcap(const std::filesystem::path& path);

}  // namespace roomradar
