// kept_frames.hpp: frame source in memory, so that measurements exclude the time of reading or rendering
// frames.
#pragma once
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "mapping/types/frame_source.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

class KeptFrames final : public FrameSource {
 public:
  /// `frames` must outlive this object.
  KeptFrames(const std::vector<Frame>& frames, std::string name) : frames_(frames), name_(std::move(name)) {}

  ReadResult next(Frame& frame) override {
    if (position_ == frames_.size()) return {ReadStatus::kEnd, {}};
    const auto start = std::chrono::steady_clock::now();
    frame = frames_[position_++];
    spent_ms_ += ms_since(start);
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override {
    position_ = 0;
    return true;
  }
  bool seek(std::int64_t index) override {
    if (index < 0 || index >= std::ssize(frames_)) return false;
    position_ = static_cast<std::size_t>(index);
    return true;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::ssize(frames_); }
  [[nodiscard]] std::string name() const override { return name_; }
  /// Returns the total time spent copying frames, ms.
  [[nodiscard]] double spent_ms() const { return spent_ms_; }

 private:
  const std::vector<Frame>& frames_;
  std::string name_;
  std::size_t position_ = 0;
  double spent_ms_ = 0.0;
};

}  // namespace roomradar
