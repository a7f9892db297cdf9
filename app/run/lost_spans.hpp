// lost_spans.hpp: records the frames in which the camera was not localised, with messages for the user.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace roomradar {

/// Frames are given by their index in the recording.
struct LostSpan {
  std::int64_t from = 0;   ///< first frame not localised
  std::int64_t until = 0;  ///< first frame localised again; -1: none so far
};

struct LostSpans {
  std::vector<LostSpan> spans;

  /// Call for each frame. Returns a message for the user if the state has changed, else an empty string.
  std::string add(std::int64_t frame_index, bool is_located);
};

}  // namespace roomradar
