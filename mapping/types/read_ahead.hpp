// read_ahead.hpp: reads and prepares the next frame of a source while the caller processes the previous one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <utility>
#include <vector>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Delivers wanted frames of a source. Seeks past the others if the source can seek. While the caller uses a
/// frame, a second thread reads the next one and prepares it. The caller must not use the source meanwhile.
/// @tparam Prepared  what is computed of each frame on the second thread
template <typename Prepared>
class ReadAhead {
 public:
  /// @param position  number of frames that were read from the source before
  /// @param wanted    positions (numbers of frames before) of the frames to deliver, increasing and at least
  ///                  `position`. Reading ahead beyond the last one would block on a live source
  /// @param prepare   called on the second thread with each wanted frame, while the caller uses the one
  /// before
  ReadAhead(FrameSource& source, std::int64_t position, std::vector<std::int64_t> wanted,
            std::function<void(const Frame&, Prepared&)> prepare)
      : source_(source), position_(position), wanted_(std::move(wanted)), prepare_(std::move(prepare)) {}

  /// As FrameSource::next(). Swaps `prepared` with what prepare() made of the frame. Returns kEnd after the
  /// last wanted frame. Rethrows errors of the source and of prepare().
  ReadResult next(Frame& frame, Prepared& prepared) {
    if (next_ == wanted_.size()) return {};
    if (!is_read_.valid()) read_next();
    ReadResult result = is_read_.get();
    if (result.status == ReadStatus::kEnd) return result;
    if (result.status == ReadStatus::kFrame) {
      std::swap(frame, ahead_);
      std::swap(prepared, prepared_);
    }
    if (result.status != ReadStatus::kWaiting) ++next_;
    if (next_ < wanted_.size()) read_next();
    return result;
  }

  /// Position of the frame that next() delivered last. Call after the first next() only.
  [[nodiscard]] std::int64_t position() const { return wanted_[next_ - 1]; }

 private:
  void read_next() {
    is_read_ = std::async(std::launch::async, [this] { return read(); });
  }

  ReadResult read() {
    const std::int64_t wanted = wanted_[next_];
    if (position_ < wanted && source_.seek(wanted)) position_ = wanted;
    for (;;) {
      ReadResult result = source_.next(ahead_);
      if (result.status == ReadStatus::kEnd || result.status == ReadStatus::kWaiting) return result;
      if (position_++ < wanted) continue;
      if (result.status == ReadStatus::kFrame) prepare_(ahead_, prepared_);
      return result;
    }
  }

  FrameSource& source_;
  std::int64_t position_;  ///< of the source
  std::vector<std::int64_t> wanted_;
  std::function<void(const Frame&, Prepared&)> prepare_;
  std::size_t next_ = 0;  ///< index in wanted_ of the next frame to deliver
  Frame ahead_;           ///< filled by the second thread, as is prepared_
  Prepared prepared_;
  std::future<ReadResult> is_read_;  ///< declared last: its destructor waits for the thread
};

}  // namespace roomradar
