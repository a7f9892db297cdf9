// klg.hpp: recordings of ElasticFusion's and Kintinuous' Logger, .klg files.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true if the file's name ends in .klg.
[[nodiscard]] bool is_klg(const std::filesystem::path& path);

/// Lists the frames of a .klg file. The file contains the number of frames, then per frame a stamp (us), the
/// sizes of both images, depth (16 bit, mm, zlib or raw) and colour (JPEG, raw RGB or none). Depth is
/// registered to colour. The file contains no intrinsics. Like ElasticFusion, this reader assumes a focal
/// length of 528 px at a width of 640 px. A truncated file is read up to its last complete frame.
/// @throws Error naming the file if it is damaged
RecordingFacts index_klg(const std::filesystem::path& path);

}  // namespace roomradar
