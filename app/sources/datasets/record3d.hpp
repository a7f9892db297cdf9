// record3d.hpp: recordings of an iPhone or iPad with LiDAR, exported by Record3D.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true if `folder` contains the file metadata or metadata.json, and the folder `depth`, as an export
/// by Record3D does. Also for Record3D's own form, a file .r3d or a folder `rgbd`, which index_record3d()
/// refuses.
[[nodiscard]] bool is_record3d(const std::filesystem::path& folder);

/// Lists the frames of an export by Record3D ("EXR + RGB"):
///   metadata      or metadata.json: w, h: colour size; dw, dh: depth size, px; K: intrinsics at w x h,
///   column-major;
///                 poses: qx qy qz qw x y z (m) per frame; frameTimestamps (s) per frame
///   depth/N.exr   depth of frame N, m;  rgb/N.jpg: its colour image
/// N has no leading zeros. Without frameTimestamps, stamps are N / fps, with 30 as the default of fps.
/// `poses` may be longer or shorter than the number of frames, absent, or null where tracking was lost. The
/// recorded camera frame has y up and z backwards, and the recorded world frame has y up. Both are converted
/// to roomradar's axes. Depth is registered to the
/// colour camera. Gravity follows from the poses, since ARKit aligns its world frame with gravity.
/// @throws Error naming the file if the metadata are damaged or do not fit the images
RecordingFacts index_record3d(const std::filesystem::path& folder);

}  // namespace roomradar
