// folder_source.hpp: a recording on disk as a frame source.
#pragma once
#include <filesystem>
#include <memory>

#include "app/sources/formats/source_options.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Opens the recording in `folder` and recognises its format by the files in it:
///   fakenect      INDEX.txt with d-*.pgm (raw 11 bit), r-*.ppm, a-*.dump (accelerometer)
///   TUM RGB-D     depth.txt, rgb.txt; optional groundtruth.txt, accelerometer.txt
///   7-Scenes      frame-XXXXXX.depth.png, .color.jpg, .color.png or .color.none (empty: no colour),
///                 optional .pose.txt
///   numbered      depth/NNNNN.png (mm), optional color/NNNNN.jpg or .png
/// Intrinsics come from the folder's camera.json (camera_rig.hpp), else from camera-intrinsics.txt (3 x 3,
/// depth camera), else from the format's published values, scaled to the images' width.
///
/// Files are read on demand; next() handles single unreadable frames as FrameSource describes. The source
/// rewinds, seeks, and knows its frame count.
/// @throws Error if the folder is absent, empty or of none of these formats (the message lists them), if a
/// list in it is unusable as a whole, if none of its first ten frames can be read, or if the intrinsics do
/// not match the images.
std::unique_ptr<FrameSource> open_folder(const std::filesystem::path& folder,
                                         const SourceOptions& options = {});

}  // namespace roomradar
