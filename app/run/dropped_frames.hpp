// dropped_frames.hpp: counts the frames that a live source dropped in favour of newer ones.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

namespace roomradar {

/// Counts gaps in the frames' indices: dropped frames have an index too.
struct DroppedFrames {
  std::int64_t count = 0;
  std::optional<std::int64_t> first_index;

  /// @param index  index of a frame
  /// @param read   number of frames read so far, including this one and unusable ones
  void see(std::int64_t index, std::int64_t read) {
    if (!first_index) first_index = index - (read - 1);
    count = std::max(count, index - *first_index - (read - 1));
  }
};

}  // namespace roomradar
