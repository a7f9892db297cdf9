// record3d.hpp: recordings of an iPhone or iPad with LiDAR, exported by Record3D.
#pragma once
#include <filesystem>

#include "app/sources/datasets/indexed_source.hpp"

namespace roomradar {

/// Returns true if `folder` holds an export by Record3D: `metadata` and a folder `depth`.
[[nodiscard]] bool is_record3d(const std::filesystem::path& folder);

/// Reads the list of an export by Record3D ("EXR + RGB"):
///   metadata      JSON: w, h: colour size; dw, dh: depth size, px; K: intrinsics at w x h, column-major;
///                 poses: qx qy qz qw x y z (m) per frame; frameTimestamps (s) per frame
///   depth/N.exr   depth of frame N, m;  rgb/N.jpg: its colour image
/// N has no leading zeros. More poses than frames may be listed. The recorded camera frame has y up and z
/// backwards, the recorded world has y up; both are converted to roomradar's, so the world has z up. The
/// depth is registered to the colour camera. Gravity follows from the poses, whose world ARKit aligns with
/// it.
/// @throws Error naming the file if the metadata are damaged or do not fit the images
IndexedRecording index_record3d(const std::filesystem::path& folder);

}  // namespace roomradar
