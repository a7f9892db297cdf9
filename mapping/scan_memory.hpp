// scan_memory.hpp: estimates the memory of a prescan before it begins.
#pragma once
#include <cstdint>
#include <optional>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Temporary memory of surface extraction, as a multiple of the octree's own memory. Measured: 1.6 to 2.1 for
/// octrees of 9 to 98 MB.
inline constexpr double kSurfaceMemory = 3.0;

struct MemoryEstimate {
  std::int64_t frames = 0;  ///< frames assumed: the source's, or one minute's if the length is unknown
  bool length_known = false;
  double octree_bytes = 0.0;
  double process_bytes = 0.0;  ///< peak of the whole process
};

/// Fuses four frames spread over the source, or only the first if the source cannot seek. Assumes that the
/// octree grows by one frame's size every 80 frames, up to 20 times. Accurate within a factor of 1.5 for
/// walks round rooms and tables. Rewinds the source. Returns nullopt if rewinding fails or no frame there is
/// readable.
std::optional<MemoryEstimate> estimate_memory(FrameSource& source, double resolution_m);

}  // namespace roomradar
