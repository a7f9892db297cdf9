// cached_source.hpp: caches the frames of a slow source on disk, for callers that read each frame several
// times.
#pragma once
#include <cstdint>
#include <memory>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Max size of the cached images, uncompressed: 1,400 frames of 640 x 480. Their files take about a third.
inline constexpr std::uintmax_t kMaxFrameCache_bytes = 3'000'000'000;

/// Returns a source that delivers the frames of `source`, identical in all bits, and reads each frame from
/// `source` only once. Keeps the frames in a temporary folder until the returned source is destroyed. Caching
/// ends at max_bytes or at the first frame that cannot be written. Frames that are not cached, or no longer
/// readable in the folder, are read from `source`. Useful if reading a frame from `source` takes longer than
/// reading it from disk. An example is SimulatedSource.
/// @param source  returned as it is if it cannot seek, or if no temporary folder can be created
std::unique_ptr<FrameSource> cache_frames(std::unique_ptr<FrameSource> source,
                                          std::uintmax_t max_bytes = kMaxFrameCache_bytes);

}  // namespace roomradar
