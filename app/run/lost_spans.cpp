// lost_spans.cpp: starts and ends spans of lost frames.
#include "app/run/lost_spans.hpp"

namespace roomradar {

std::string LostSpans::add(std::int64_t frame_index, bool is_located) {
  last_frame = frame_index;
  const bool was_lost = !spans.empty() && spans.back().until < 0;
  if (is_located != was_lost) return {};
  if (!is_located) {
    spans.push_back({frame_index, -1});
    return "frame " + std::to_string(frame_index) + ": the camera is not localised";
  }
  spans.back().until = frame_index;
  return "frame " + std::to_string(frame_index) + ": the camera is localised again";
}

}  // namespace roomradar
