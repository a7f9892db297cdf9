// video_module.hpp: loads the module for videos when a video is first read or written.
#pragma once
#include "app/sources/video/video_codecs.hpp"

namespace roomradar {

/// Returns the codecs of the module roomradar-video.so, which is loaded on the first call and never unloaded.
/// OpenCV's library for videos loads 240 others: too many for every start of the program. The module is
/// searched beside the binary that contains this function, then in lib/roomradar of the folders one and two
/// above it, of the prefix that was configured, and of /usr. Thread safe.
/// @throws Error if the module is not installed, cannot be loaded, or is of another version
const VideoCodecs& video_codecs();

}  // namespace roomradar
