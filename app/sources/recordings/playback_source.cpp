// playback_source.cpp: computes the stamps of held, repeated and rewound frames.
#include "app/sources/recordings/playback_source.hpp"

#include <algorithm>
#include <utility>

namespace roomradar {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;  // frame period of a Kinect
constexpr double kJump_s = 0.25;         // larger than between any frames of a recording

}  // namespace

PlaybackSource::PlaybackSource(std::unique_ptr<FrameSource> source, AtEnd at_end)
    : source_(std::move(source)), at_end_(at_end) {}

ReadResult PlaybackSource::next(Frame& frame) {
  if (is_held_ && last_stamp_s_) return repeat(frame);
  is_repeating_ = false;
  ReadResult result = source_->next(frame);
  if (result.status == ReadStatus::kEnd && last_stamp_s_) {
    if (at_end_ == AtEnd::kLoop && rewind()) result = source_->next(frame);
    if (result.status == ReadStatus::kEnd && at_end_ != AtEnd::kEnd) return repeat(frame);
  }
  if (result.status != ReadStatus::kFrame) return result;
  const bool was_again = is_again_ && !was_repeated_;
  is_again_ = frame.index <= newest_index_;
  if (last_stamp_s_) follow(frame.stamp_s, was_again && !is_again_);
  was_repeated_ = false;
  newest_index_ = std::max(newest_index_, frame.index);
  frame.stamp_s += stamp_offset_s_;
  last_stamp_s_ = frame.stamp_s;
  return result;
}

void PlaybackSource::follow(double stamp_s, bool is_new_after_rewind) {
  const double following_s = *last_stamp_s_ + kFrame_s - stamp_s;
  if (was_repeated_ || is_new_after_rewind) old_ = kOld;
  if (frames_to_rebase_ > 0) {
    stamp_offset_s_ = following_s;
  } else if (was_repeated_) {  // a device's clock advanced while a frame was held
    stamp_offset_s_ = std::max(stamp_offset_s_, following_s);
    // the jump of the device's clock is here
  } else if (old_ > 0 && stamp_s + stamp_offset_s_ > *last_stamp_s_ + kJump_s) {
    stamp_offset_s_ = std::max(least_offset_s_, following_s);
  }
  frames_to_rebase_ = std::max(frames_to_rebase_ - 1, 0);
  old_ = std::max(old_ - 1, 0);
  if (old_ == 0 && !is_again_) least_offset_s_ = stamp_offset_s_;
}

ReadResult PlaybackSource::repeat(Frame& frame) {
  is_repeating_ = is_again_ = was_repeated_ = true;
  frame.stamp_s = *last_stamp_s_ + kFrame_s;
  last_stamp_s_ = frame.stamp_s;
  return {ReadStatus::kFrame, {}};
}

bool PlaybackSource::rewind() {
  if (!source_->rewind()) return false;
  frames_to_rebase_ = std::max(frames_to_rebase_, 1);
  return true;
}

std::optional<std::int64_t> PlaybackSource::frame_count() const {
  return at_end_ == AtEnd::kEnd ? source_->frame_count() : std::nullopt;
}

}  // namespace roomradar
