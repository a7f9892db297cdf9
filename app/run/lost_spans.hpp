// lost_spans.hpp: records the frames in which the camera was not localised, with messages for the user.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace roomradar {

/// A span of frames without a camera pose. Frames are given by their index in the recording.
struct LostSpan {
  /// First frame that was not localised.
  std::int64_t from = 0;
  /// First frame that was localised again; -1 if none has been so far.
  std::int64_t until = 0;
};

struct LostSpans {
  std::vector<LostSpan> spans;

  /// Records whether a frame was localised; call for each frame. Returns a message for the user if this
  /// differs from the previous frame, otherwise an empty string.
  std::string add(std::int64_t frame_index, bool is_located);
};

}  // namespace roomradar
