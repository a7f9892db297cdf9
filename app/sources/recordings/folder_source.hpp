// folder_source.hpp: a recording on disk as a source of frames.
#pragma once
#include <filesystem>
#include <memory>

#include "app/sources/formats/source_options.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Opens the recording in `folder`, recognised by what is in it:
///   fakenect      INDEX.txt with d-*.pgm (raw 11 bit), r-*.ppm, a-*.dump (accelerometer)
///   TUM RGB-D     depth.txt, rgb.txt; optional groundtruth.txt, accelerometer.txt
///   7-Scenes      frame-XXXXXX.depth.png, .color.jpg, .color.png or .color.none (empty: it came without),
///                 optional .pose.txt
///   numbered      depth/NNNNN.png (mm), optional color/NNNNN.jpg or .png
/// A camera.json in the folder gives the intrinsics (camera_rig.hpp); else camera-intrinsics.txt (3 x 3,
/// depth camera); else the format's published figures, scaled to the width of its images.
///
/// Files are read as frames are asked for; next() takes single bad frames as FrameSource says. The source
/// rewinds, seeks, and knows its frame count.
/// @throws Error if the folder is absent, empty or of no kind above (the message lists these), if a list in
/// it is broken as a whole, if none of its first ten frames can be read, or if the intrinsics do not fit the
/// images.
std::unique_ptr<FrameSource> open_folder(const std::filesystem::path& folder,
                                         const SourceOptions& options = {});

}  // namespace roomradar
