// make_folder.hpp: creates folders, with the true cause if that fails.
#pragma once
#include <filesystem>

namespace roomradar {

/// Creates the folder and its parents; does nothing if it exists. Throws Error naming the folder and the
/// existing folder above it that refuses. The latter is not writable, or is in a file system such as /proc
/// that holds no files of users. For /proc, the system's own message is "No such file or directory".
void make_folder(const std::filesystem::path& folder);

}  // namespace roomradar
