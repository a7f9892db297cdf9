// opencv_video.hpp: the entry point of the video codec module.
#pragma once
#include "app/sources/video/video_codecs.hpp"

/// Returns the codecs, or nullptr if `version` is not the version that the module was built with.
extern "C" const roomradar::VideoCodecs* roomradar_video_codecs(const char* version);
