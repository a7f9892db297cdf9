// trade_frames.hpp: reads the frames on which settings are measured.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/types/frame.hpp"

namespace roomradar {

inline constexpr std::size_t kFewestTradeFrames = 30;

/// Returns the readable frames among a recording's first `count`. Throws Error if the recording cannot be
/// read, has fewer than kFewestTradeFrames readable frames, or has a frame without a pose (the ground truth).
std::vector<Frame> frames_of_recording(const std::string& folder, std::int64_t count);

}  // namespace roomradar
