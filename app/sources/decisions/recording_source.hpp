// recording_source.hpp: a decided recording as a frame source.
#pragma once
#include <memory>

#include "app/sources/decisions/decide.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Returns a source that delivers the recording's frames, and can rewind and seek. Images are read on demand,
/// and lens distortion is removed. A frame whose depth cannot be read is skipped, however many there are. A
/// frame whose colour cannot be read is delivered without colour. Both are counted in the report.
/// @throws Error if a camera is invalid
std::unique_ptr<FrameSource> recording_source(DecidedRecording recording);

}  // namespace roomradar
