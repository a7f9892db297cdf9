// recording_index_tum.hpp: lists the frames of a TUM RGB-D recording.
#pragma once
#include <filesystem>

#include "app/sources/recordings/recording_index.hpp"

namespace roomradar {

/// Lists the frames of a folder in the TUM RGB-D format: depth.txt, and rgb.txt, groundtruth.txt and
/// accelerometer.txt if present. Throws Error as open_folder() does.
RecordingIndex index_tum(const std::filesystem::path& folder);

}  // namespace roomradar
