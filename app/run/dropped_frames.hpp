// dropped_frames.hpp: counts the frames that a live source dropped because newer frames had arrived.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

namespace roomradar {

/// Counts gaps in the frames' indices, since the source numbers dropped frames, too.
struct DroppedFrames {
  std::int64_t count = 0;  ///< number of frames dropped so far
  /// Index of the first frame that was passed to see(), minus the number of frames read before it.
  std::optional<std::int64_t> first_index;

  /// Updates the count with the frame of this index.
  /// @param read   number of frames read so far, including this frame and frames that were unusable
  void see(std::int64_t index, std::int64_t read) {
    if (!first_index) first_index = index - (read - 1);
    count = std::max(count, index - *first_index - (read - 1));
  }
};

}  // namespace roomradar
