// read_ahead.hpp: reads a recording's next frame on a second thread while the caller uses the current one.
#pragma once
#include <memory>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Wraps a source so that it delivers the same results in the same order, but reads one frame ahead while
/// frames are read in sequence. The first frame, and the first after a rewind or a seek, are read without a
/// second thread: callers that jump from frame to frame would discard what was read ahead. A fault of a frame
/// that was read ahead is thrown by the call of next() that would deliver it. Not for live devices, whose
/// frames are kept in a queue of their own.
std::unique_ptr<FrameSource> read_ahead(std::unique_ptr<FrameSource> source);

}  // namespace roomradar
