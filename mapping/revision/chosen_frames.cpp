// chosen_frames.cpp: seeks to each chosen frame, and reads the next one asynchronously.
#include "mapping/revision/chosen_frames.hpp"

#include <utility>

#include "mapping/types/system/error.hpp"

namespace roomradar {

ChosenFrames::ChosenFrames(FrameSource& source, std::span<const FusedFrame> fused,
                           std::vector<std::size_t> chosen, StageTimes& times)
    : source_(source), fused_(fused), chosen_(std::move(chosen)), times_(times) {
  if (!source.rewind()) throw Error(source.name() + ": cannot be read again");
  read_ahead();
}

bool ChosenFrames::next(Frame& frame, std::size_t& index) {
  while (next_ < chosen_.size()) {
    const bool is_same = times_.timed("read", [&] { return is_read_.get(); });
    index = chosen_[next_++];
    if (is_same) std::swap(frame, ahead_);
    read_ahead();
    if (is_same) return true;
  }
  return false;
}

void ChosenFrames::read_ahead() {
  if (next_ == chosen_.size()) return;
  is_read_ = std::async(std::launch::async,
                        [this, &chosen = fused_[chosen_[next_]]] { return read(chosen, ahead_); });
}

/// Returns false if the source does not deliver the same frame as before.
bool ChosenFrames::read(const FusedFrame& chosen, Frame& frame) {
  if (position_ != chosen.position && source_.seek(chosen.position)) position_ = chosen.position;
  while (position_ <= chosen.position) {
    const ReadResult result = source_.next(frame);
    if (result.status == ReadStatus::kEnd) return false;
    if (position_++ == chosen.position)
      return result.status == ReadStatus::kFrame && frame.index == chosen.frame_index;
  }
  return false;
}

}  // namespace roomradar
