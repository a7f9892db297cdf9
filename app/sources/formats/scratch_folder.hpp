// temporary_folder.hpp: creates a new temporary folder.
#pragma once
#include <filesystem>

namespace roomradar {

/// Creates an empty folder in `parent`, or in the system's temporary folder if `parent` is empty. Throws
/// Error on failure. The caller removes the folder.
std::filesystem::path make_temporary_folder(std::filesystem::path parent = {});

}  // namespace roomradar
