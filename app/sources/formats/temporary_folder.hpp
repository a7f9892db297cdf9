// temporary_folder.hpp: a fresh folder for files that go with the process.
#pragma once
#include <filesystem>

namespace roomradar {

/// Made in `parent`, or where the system keeps such if that is empty. Throws Error if none can be made.
std::filesystem::path make_temporary_folder(std::filesystem::path parent = {});

}  // namespace roomradar
