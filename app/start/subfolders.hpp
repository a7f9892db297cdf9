// subfolders.hpp: lists the folders and the files in a folder.
#pragma once
#include <filesystem>
#include <vector>

namespace roomradar {

/// Returns the subfolders of `folder` in sorted order, without hidden ones, at most the first 300 that the
/// system lists. Returns none if the folder cannot be read.
std::vector<std::filesystem::path> subfolders(const std::filesystem::path& folder);

/// Returns the regular files in `folder` by the same rules.
std::vector<std::filesystem::path> files_in_folder(const std::filesystem::path& folder);

}  // namespace roomradar
