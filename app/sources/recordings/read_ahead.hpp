// read_ahead.hpp: reads a recording's next frame on a second thread while the caller uses the current one.
#pragma once
#include <memory>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Returns a source that delivers the results of `source` in the same order, but reads one frame ahead on a
/// second thread. The first frame, and the first frame after a rewind or seek, are read without the second
/// thread, since callers that seek repeatedly would discard frames read ahead. An error in a frame that was
/// read ahead is thrown by the call of next() that delivers the frame. Not for live devices, which have their
/// own queue.
std::unique_ptr<FrameSource> read_ahead(std::unique_ptr<FrameSource> source);

}  // namespace roomradar
