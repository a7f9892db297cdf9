// scan_memory.hpp: estimates the memory that a prescan will need.
#pragma once
#include <cstdint>
#include <optional>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Temporary memory of surface extraction, as a multiple of the octree's own memory. Measured for the
/// extraction alone: 3.5 for an octree of 20 MB, 2.8 for 34 MB, 1.8 for 203 MB. The rest is a margin.
inline constexpr double kSurfaceMemory = 4.0;

struct MemoryEstimate {
  std::int64_t frames = 0;  ///< number of frames in the source; that of one minute if unknown
  bool length_known = false;
  double octree_bytes = 0.0;
  double process_bytes = 0.0;  ///< peak of the whole process
};

/// Estimates the memory from four single frames, evenly spread over the source. Uses only the first frame if
/// the source cannot seek. Assumes that the octree grows by the mean size of one frame's octree every 80
/// frames, up to 20 times this size. The estimate is accurate within a factor of 1.5 for camera trajectories
/// around rooms and tables. Rewinds the source. Returns nullopt if rewinding fails or none of these frames is
/// readable.
std::optional<MemoryEstimate> estimate_memory(FrameSource& source, double resolution_m);

}  // namespace roomradar
