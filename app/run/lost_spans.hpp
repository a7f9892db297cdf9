// lost_spans.hpp: records spans of frames in which the camera was not localised, and returns messages about
// them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace roomradar {

/// Consecutive frames without a camera pose, given by their indices in the recording.
struct LostSpan {
  /// First frame that was not localised.
  std::int64_t from = 0;
  /// First localised frame after the span; -1 while there is none.
  std::int64_t until = 0;
};

struct LostSpans {
  std::vector<LostSpan> spans;
  std::int64_t last_frame = -1;  ///< index of the last frame added; -1: none

  /// Records whether a frame was localised. Call for each frame. Returns a message for the user if
  /// localisation was lost or regained in this frame, otherwise an empty string.
  std::string add(std::int64_t frame_index, bool is_located);
};

}  // namespace roomradar
