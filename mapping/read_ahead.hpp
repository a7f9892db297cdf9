// read_ahead.hpp: reads the next frame of a source while the caller processes the previous one.
#pragma once
#include <cstdint>
#include <future>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Delivers the next frames of a source. While the caller uses a frame, a second thread reads the next one.
/// The caller must not use the source meanwhile.
class ReadAhead {
 public:
  /// @param frames  number of frames to read. Reading ahead beyond it would block on a live source
  ReadAhead(FrameSource& source, std::int64_t frames) : source_(source), left_(frames) {}

  /// As FrameSource::next(). Returns kEnd after the last frame. Rethrows errors of the source.
  ReadResult next(Frame& frame);

 private:
  FrameSource& source_;
  std::int64_t left_;                ///< frames still to be delivered, including unreadable ones
  Frame ahead_;                      ///< filled by the second thread
  std::future<ReadResult> is_read_;  ///< declared last: its destructor waits for the thread
};

}  // namespace roomradar
