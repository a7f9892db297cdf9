// controlled_source.cpp: checks the channel's requests before each frame of the first pass.
#include "app/scan/controlled_source.hpp"

#include <utility>

namespace roomradar {
namespace {

class ControlledSource final : public WrappedSource {
 public:
  ControlledSource(std::unique_ptr<FrameSource> source, ScanChannel& channel)
      : WrappedSource(std::move(source)), channel_(channel) {}

  ReadResult next(Frame& frame) override {
    if (is_controlled_) {
      channel_.wait_while_paused();
      throw_if_discarded(channel_);
      if (channel_.requested() == ScanRequest::kFinish) return ended();
    }
    const ReadResult result = source_.next(frame);
    return result.status == ReadStatus::kEnd ? ended() : result;
  }

 private:
  ScanChannel& channel_;
  bool is_controlled_ = true;  ///< until the first end: then the frames have been chosen

  ReadResult ended() {
    is_controlled_ = false;
    return {ReadStatus::kEnd, {}};
  }
};

}  // namespace

void throw_if_discarded(const ScanChannel& channel) {
  if (channel.requested() == ScanRequest::kDiscard) throw ScanDiscarded("the scan was discarded");
}

std::unique_ptr<FrameSource> controlled(std::unique_ptr<FrameSource> source, ScanChannel& channel) {
  return std::make_unique<ControlledSource>(std::move(source), channel);
}

}  // namespace roomradar
