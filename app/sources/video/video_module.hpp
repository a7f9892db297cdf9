// video_module.hpp: loads the video codec module when a video is first read or written.
#pragma once
#include "app/sources/video/video_codecs.hpp"

namespace roomradar {

/// Returns the codecs of the module roomradar-video.so, which is loaded on the first call and never unloaded.
/// The module is separate because OpenCV's video library loads 240 other libraries, too many for every start
/// of the program. The module is first searched for in the folder of the binary that contains this function.
/// The next candidates are lib/roomradar in the parent and grandparent of that folder, in the configured
/// prefix, and in /usr. Thread safe.
/// @throws Error if the module is not installed, cannot be loaded, or has a different version from the
/// program's
const VideoCodecs& video_codecs();

}  // namespace roomradar
