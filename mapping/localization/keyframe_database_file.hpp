// keyframe_database_file.hpp: writes and reads the keyframe database as a binary file.
#pragma once
#include <filesystem>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/storage/binary_file.hpp"

namespace roomradar {

/// Writes the database to `path`, with a checksum. Throws Error if the file cannot be written.
void write_keyframe_database(const KeyframeDatabase& keyframe_database, const std::filesystem::path& path);

/// Reads a file written by write_keyframe_database(). Throws Error naming the file and the fault if the file
/// is missing, truncated, altered, or of another version. Sizes are checked before memory is allocated.
KeyframeDatabase read_keyframe_database(const std::filesystem::path& path,
                                        FileChecksum checksum = FileChecksum::kCompared);

}  // namespace roomradar
