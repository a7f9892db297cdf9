// dropped_frames.hpp: how many frames did a live source drop for newer ones?
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

namespace roomradar {

/// Told by their indices: every frame that was read before, and those that were dropped, have a lower one.
struct DroppedFrames {
  std::int64_t count = 0;
  std::optional<std::int64_t> first_index;

  /// @param index  of a frame
  /// @param read   frames so far, with it and with those that could not be used
  void see(std::int64_t index, std::int64_t read) {
    if (!first_index) first_index = index - (read - 1);
    count = std::max(count, index - *first_index - (read - 1));
  }
};

}  // namespace roomradar
