// playback_source.cpp: hold, rewind and repeat.
#include "app/sources/playback_source.hpp"

#include <algorithm>
#include <utility>

namespace roomradar {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;  // the Kinect's

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
  if (last_stamp_s_ && (anew_ > 0 || was_repeated_)) {
    const double following_s = *last_stamp_s_ + kFrame_s - frame.stamp_s;
    // A device's clock went on while a frame was held.
    stamp_offset_s_ = anew_ > 0 ? following_s : std::max(stamp_offset_s_, following_s);
  }
  anew_ = std::max(anew_ - 1, 0);
  was_repeated_ = false;
  is_again_ = frame.index <= newest_index_;
  newest_index_ = std::max(newest_index_, frame.index);
  frame.stamp_s += stamp_offset_s_;
  last_stamp_s_ = frame.stamp_s;
  return result;
}

ReadResult PlaybackSource::repeat(Frame& frame) {
  is_repeating_ = is_again_ = was_repeated_ = true;
  frame.stamp_s = *last_stamp_s_ + kFrame_s;
  last_stamp_s_ = frame.stamp_s;
  return {ReadStatus::kFrame, {}};
}

bool PlaybackSource::rewind() {
  if (!source_->rewind()) return false;
  anew_ = std::max(anew_, 1);
  return true;
}

std::optional<std::int64_t> PlaybackSource::frame_count() const {
  return at_end_ == AtEnd::kEnd ? source_->frame_count() : std::nullopt;
}

}  // namespace roomradar
