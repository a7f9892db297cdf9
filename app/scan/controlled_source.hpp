// controlled_source.hpp: a frame source that the scan window can pause and end.
#pragma once
#include <memory>

#include "app/scan/scan_channel.hpp"
#include "mapping/types/frame_source.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

/// Thrown when the user discards the scan.
struct ScanDiscarded : Error {
  using Error::Error;
};
/// Throws ScanDiscarded if the channel requests it.
void throw_if_discarded(const ScanChannel& channel);

/// Returns a source that delivers the frames of `source`, waits while the channel is paused, and ends when
/// the channel requests to finish. Throws ScanDiscarded if the scan is discarded. After its first end, the
/// source ignores the channel.
/// @param channel  must outlive the source
std::unique_ptr<FrameSource> controlled(std::unique_ptr<FrameSource> source, ScanChannel& channel);

}  // namespace roomradar
