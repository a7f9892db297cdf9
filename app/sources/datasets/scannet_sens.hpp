// scannet_sens.hpp: recordings of ScanNet, .sens files.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true if the file's name ends in .sens and it begins with version 4.
[[nodiscard]] bool is_scannet_sens(const std::filesystem::path& path);

/// Lists the frames of a .sens file, version 4: cameras and extrinsics of depth and colour (4 x 4, float),
/// then per frame the pose (camera to world; not finite where tracking was lost), stamps (us), a JPEG, PNG or
/// raw image, and depth (16 bit, zlib or raw; the file states the units per m). A truncated file is read up
/// to its last complete frame.
/// @throws Error naming the file if its header is damaged, or its depth has another compression
/// Source: Dai et al., ScanNet, CVPR 2017; SensReader.
RecordingFacts index_scannet_sens(const std::filesystem::path& path);

}  // namespace roomradar
