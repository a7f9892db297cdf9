// folder_source.hpp: a recording on disk as a frame source.
#pragma once
#include <filesystem>
#include <memory>

#include "app/sources/formats/source_options.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Opens a recording (folder or file) and recognises its format by its content. The formats that
/// index_foreign() opens are listed in app/sources/README.md. All other formats are folders:
///   fakenect      INDEX.txt with d-*.pgm (raw 11 bit), r-*.ppm, a-*.dump (accelerometer)
///   TUM RGB-D     depth.txt, rgb.txt; optional groundtruth.txt, accelerometer.txt
///   7-Scenes      frame-XXXXXX.depth.png, .color.jpg, .color.png or .color.none (empty: no colour),
///                 optional .pose.txt
///   numbered      depth/NNNNN.png (mm), optional color/NNNNN.jpg or .png
/// Intrinsics are read from the folder's camera.json (camera_rig.hpp). If it does not exist, they are read
/// from camera-intrinsics.txt (3 x 3 matrix of the depth camera). If neither file exists, the format's
/// published values are scaled to the images' width.
///
/// Image files are read on demand. next() reports unreadable frames as FrameSource describes. The source can
/// rewind and seek, and knows its number of frames.
/// @throws Error if the folder is absent, empty or in none of these formats (the message lists them). Also
///         throws if one of its lists is unusable, none of its first ten frames is readable, or the
///         intrinsics do not match the images
std::unique_ptr<FrameSource> open_folder(const std::filesystem::path& folder,
                                         const SourceOptions& options = {});

}  // namespace roomradar
