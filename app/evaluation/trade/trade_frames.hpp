// trade_frames.hpp: the frames on which settings are measured.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/types/frame.hpp"

namespace roomradar {

inline constexpr std::size_t kFewestTradeFrames = 30;

/// The first frames of a folder, up to `count` of them. Throws Error if it cannot be read, fewer than
/// kFewestTradeFrames are readable, or they come without poses: nothing could be said of errors then.
std::vector<Frame> frames_of_recording(const std::string& folder, std::int64_t count);

}  // namespace roomradar
