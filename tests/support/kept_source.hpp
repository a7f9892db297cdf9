// kept_source.hpp: a frame source that delivers frames from memory.
#pragma once
#include <utility>
#include <vector>

#include "mapping/types/frame_source.hpp"

namespace roomradar::test {

class KeptSource final : public FrameSource {
 public:
  explicit KeptSource(std::vector<Frame> frames) : frames_(std::move(frames)) {}

  ReadResult next(Frame& frame) override {
    if (next_ == frames_.size()) return {ReadStatus::kEnd, {}};
    frame = frames_[next_++];
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override {
    next_ = 0;
    return true;
  }
  bool seek(std::int64_t index) override {
    if (index < 0 || static_cast<std::size_t>(index) >= frames_.size()) return false;
    next_ = static_cast<std::size_t>(index);
    return true;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::ssize(frames_); }
  [[nodiscard]] std::string name() const override { return "frames in memory"; }

 private:
  std::vector<Frame> frames_;
  std::size_t next_ = 0;
};

}  // namespace roomradar::test
