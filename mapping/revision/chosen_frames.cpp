// chosen_frames.cpp: positions of the chosen frames, and the frames that are no longer the same.
#include "mapping/revision/chosen_frames.hpp"

#include <utility>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

std::vector<std::int64_t> positions_of(std::span<const FusedFrame> fused,
                                       const std::vector<std::size_t>& chosen) {
  std::vector<std::int64_t> positions;
  for (const std::size_t i : chosen) positions.push_back(fused[i].position);
  return positions;
}

}  // namespace

ChosenFrames::ChosenFrames(FrameSource& source, std::span<const FusedFrame> fused,
                           std::vector<std::size_t> chosen, StageTimes& times)
    : fused_(fused),
      chosen_(std::move(chosen)),
      times_(times),
      ahead_(source, 0, positions_of(fused, chosen_), [](const Frame&, std::monostate&) {}) {
  if (!source.rewind()) throw Error(source.name() + ": cannot be read again");
}

bool ChosenFrames::next(Frame& frame, std::size_t& index) {
  for (std::monostate nothing; next_ < chosen_.size();) {
    const ReadStatus status = times_.timed("read", [&] { return ahead_.next(frame, nothing).status; });
    if (status == ReadStatus::kEnd) break;
    if (status == ReadStatus::kWaiting) continue;
    index = chosen_[next_++];
    if (status == ReadStatus::kFrame && frame.index == fused_[index].frame_index) return true;
  }
  return false;
}

}  // namespace roomradar
