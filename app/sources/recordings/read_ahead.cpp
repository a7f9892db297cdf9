// read_ahead.cpp: a future holds the result of the frame that is being read.
#include "app/sources/recordings/read_ahead.hpp"

#include <future>
#include <thread>
#include <utility>

namespace roomradar {
namespace {

class ReadAheadSource final : public WrappedSource {
 public:
  explicit ReadAheadSource(std::unique_ptr<FrameSource> source) : WrappedSource(std::move(source)) {}

  ReadResult next(Frame& frame) override {
    const bool in_sequence = std::exchange(in_sequence_, true);
    const ReadResult result = ahead_.valid() ? take(frame) : source_.next(frame);
    if (in_sequence && result.status != ReadStatus::kEnd)
      ahead_ = std::async(std::launch::async, [this] { return source_.next(frame_ahead_); });
    return result;
  }

  bool rewind() override {
    return jump([this] { return source_.rewind(); });
  }
  bool seek(std::int64_t index) override {
    return jump([this, index] { return source_.seek(index); });
  }

 private:
  Frame frame_ahead_;         ///< filled by the thread; its allocations are those of frames delivered before
  bool in_sequence_ = false;  ///< a frame was read since the last jump
  std::future<ReadResult> ahead_;  ///< declared last: its destructor waits for the thread

  ReadResult take(Frame& frame) {
    ReadResult result = ahead_.get();
    if (result.status == ReadStatus::kFrame) std::swap(frame, frame_ahead_);
    return result;
  }

  /// Rewinds or seeks. The frame that was read ahead is discarded only if the source did so.
  template <typename Jump>
  bool jump(const Jump& source_jumps) {
    if (ahead_.valid()) ahead_.wait();
    if (!source_jumps()) return false;
    ahead_ = {};
    in_sequence_ = false;
    return true;
  }
};

}  // namespace

std::unique_ptr<FrameSource> read_ahead(std::unique_ptr<FrameSource> source) {
  if (std::thread::hardware_concurrency() < 2) return source;
  return std::make_unique<ReadAheadSource>(std::move(source));
}

}  // namespace roomradar
