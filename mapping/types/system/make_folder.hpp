// make_folder.hpp: creates folders, with the true cause if that fails.
#pragma once
#include <filesystem>

namespace roomradar {

/// Creates the folder and its parents; does nothing if it exists. Throws Error naming the folder and the
/// cause. The cause is the nearest existing parent folder if that is not writable, or is in a file system
/// that accepts no new files, such as /proc. For /proc, the system's own message would be a misleading "No
/// such file or directory".
void make_folder(const std::filesystem::path& folder);

}  // namespace roomradar
