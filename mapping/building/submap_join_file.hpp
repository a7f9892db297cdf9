// submap_join_file.hpp: writes and reads the joins of two submaps.
#pragma once
#include <filesystem>
#include <vector>

#include "mapping/building/submap_join.hpp"

namespace roomradar {

/// Writes the outcome of comparing two submaps. Throws Error if the file cannot be written.
void save_joins(const std::vector<SubmapJoin>& joins, const std::filesystem::path& path);
/// Reads the joins. Throws Error naming the file and the fault if it is missing, damaged or of another
/// version.
std::vector<SubmapJoin> load_joins(const std::filesystem::path& path);

}  // namespace roomradar
