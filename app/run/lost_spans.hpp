// lost_spans.hpp: from when to when a run did not know where the camera was, told as it happens.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace roomradar {

/// Frames by their index in the recording.
struct LostSpan {
  std::int64_t from = 0;   ///< the first frame that was not located
  std::int64_t until = 0;  ///< the first that was again; -1: none was
};

struct LostSpans {
  std::vector<LostSpan> spans;

  /// To be called for each frame. A sentence to tell the user, or nothing where nothing has changed.
  std::string add(std::int64_t frame_index, bool is_located);
};

}  // namespace roomradar
