// fusion_selection.hpp: chooses the frames of a long scan that are fused.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/trajectory.hpp"

namespace roomradar {

/// Default of PrescanConfig::max_fused_frames. At 30 Hz, all frames of the first minute.
inline constexpr std::int64_t kMaxFusedFrames = 2000;

/// Returns the indices of the poses whose frames are to be fused, increasing: all of them if there are at
/// most max_frames. Otherwise a frame is left out if it is one of the n - 1 frames after a chosen one, and
/// the camera has moved less than n times 5 mm and turned less than n times 0.3 degrees since that one. n is
/// the smallest of 1.25, 1.25^2, ... that leaves at most max_frames.
/// @param poses       in the order of the scan
/// @param max_frames  >= 1; 0: no limit
std::vector<std::size_t> choose_frames_to_fuse(std::span<const TimedPose> poses, std::size_t max_frames);

}  // namespace roomradar
