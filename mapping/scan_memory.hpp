// scan_memory.hpp: estimates the memory that a prescan will need.
#pragma once
#include <cstdint>
#include <optional>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Returns the temporary memory (bytes) that surface extraction needs beside the octree, with a margin.
/// Measured: 68 MB for an octree of 20 MB, 62 MB for one of 26 MB, 195 MB for one of 203 MB. Large maps need
/// less than in proportion, since their surface is extracted and simplified in parts.
double memory_after_fusion(double octree_bytes);

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
