// trade_frames.hpp: reads the frames on which settings are measured.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/types/frame.hpp"

namespace roomradar {

inline constexpr std::size_t kFewestTradeFrames = 30;

/// Returns the readable ones of a recording's first `count` frames. Throws Error if it cannot be read, has
/// fewer than kFewestTradeFrames readable frames, or a frame has no pose, as errors need ground truth.
std::vector<Frame> frames_of_recording(const std::string& folder, std::int64_t count);

}  // namespace roomradar
