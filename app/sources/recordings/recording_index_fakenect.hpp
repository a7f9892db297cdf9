// recording_index_fakenect.hpp: lists the frames of a recording made by libfreenect.
#pragma once
#include <filesystem>

#include "app/sources/recordings/recording_index.hpp"

namespace roomradar {

/// Lists the frames of a folder that libfreenect recorded, from its INDEX.txt. Throws Error as open_folder()
/// does.
RecordingIndex index_fakenect(const std::filesystem::path& folder);

}  // namespace roomradar
