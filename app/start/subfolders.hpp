// subfolders.hpp: lists the folders in a folder.
#pragma once
#include <filesystem>
#include <vector>

namespace roomradar {

/// Returns the subfolders of `folder` in sorted order, without hidden ones, at most the first 300 that the
/// system lists. Folders that cannot be read are empty.
std::vector<std::filesystem::path> subfolders(const std::filesystem::path& folder);

}  // namespace roomradar
