// trade_frames.hpp: reads the frames of a recording on which settings are measured.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/types/frame.hpp"

namespace roomradar {

/// Min number of readable frames of a recording.
inline constexpr std::size_t kFewestTradeFrames = 30;

/// Returns the readable frames among the first `count` frames of a recording. Throws Error if the recording
/// cannot be read, fewer than kFewestTradeFrames frames are readable, or a frame has no pose. The poses serve
/// as ground truth.
std::vector<Frame> frames_of_recording(const std::string& folder, std::int64_t count);

}  // namespace roomradar
