// memory_use.hpp: how much memory a prescan takes, and will take.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Memory of this process that is in use now, in bytes; 0 where the system does not say. Some 10 us.
std::size_t resident_bytes();

/// Memory that this machine has, in bytes; 0 where the system does not say.
std::uint64_t machine_bytes();

/// Gives memory that is no longer used back to the system, where that can be asked for.
void release_unused_memory();

/// From now on memory of a megabyte and more goes back to the system as soon as it is freed, where that can
/// be asked for. Else images and keyframes of many sizes leave more holes in the heap than they take: 83 MB
/// beside 55 in use, measured after 500 frames. Costs 0.5 ms a frame of a prescan. For the whole process.
void keep_large_blocks_apart();

/// What extracting the surface takes for a while, beside the octree: so many times the octree's own memory.
/// Measured: 1.6 to 2.1 for 9 to 98 MB.
inline constexpr double kSurfaceMemory = 3.0;

struct MemoryEstimate {
  std::int64_t frames = 0;  ///< that it is for: of the source, or a minute's where its length is not known
  bool length_known = false;
  double octree_bytes = 0.0;
  double process_bytes = 0.0;  ///< at the most, in all
};

/// Looks at some frames spread over the source, or at the first, and takes a room to grow by what one frame
/// shows every 80 frames, up to 20 times as much: within a factor of 1.5 for walks round rooms and tables.
/// Rewinds the source. Nothing if the source has no readable frame there.
std::optional<MemoryEstimate> estimate_memory(FrameSource& source, double resolution_m);

}  // namespace roomradar
