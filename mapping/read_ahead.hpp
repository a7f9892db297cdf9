// read_ahead.hpp: reads the next frame of a source while the caller processes the previous one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <future>
#include <utility>
#include <vector>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Delivers wanted frames of a source. Seeks past the others if the source can seek. While the caller uses a
/// frame, a second thread reads the next one. The caller must not use the source meanwhile.
class ReadAhead {
 public:
  /// @param position  number of frames that were read from the source before
  /// @param wanted    positions (numbers of frames before) of the frames to deliver, increasing and at least
  ///                  `position`. Reading ahead beyond the last one would block on a live source
  ReadAhead(FrameSource& source, std::int64_t position, std::vector<std::int64_t> wanted)
      : source_(source), position_(position), wanted_(std::move(wanted)) {}

  /// As FrameSource::next(). Returns kEnd after the last wanted frame. Rethrows errors of the source.
  ReadResult next(Frame& frame);

  /// Position of the frame that next() delivered last. Call after the first next() only.
  [[nodiscard]] std::int64_t position() const { return wanted_[next_ - 1]; }

 private:
  ReadResult read();

  FrameSource& source_;
  std::int64_t position_;  ///< of the source
  std::vector<std::int64_t> wanted_;
  std::size_t next_ = 0;             ///< index in wanted_ of the next frame to deliver
  Frame ahead_;                      ///< filled by the second thread
  std::future<ReadResult> is_read_;  ///< declared last: its destructor waits for the thread
};

}  // namespace roomradar
