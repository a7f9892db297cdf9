// frame_use.hpp: counts how much of the room and of the depth image a frame needed.
#pragma once
#include <cstddef>

#include "dynamic/surface/dynamic_cells.hpp"

namespace roomradar {

/// Counts for one localised frame.
struct FrameUse {
  std::size_t room_triangles = 0;  ///< all triangles of the static mesh
  /// Views of the static mesh rendered to localise the camera and for the expected depth. 0: the camera was
  /// stationary, so an earlier rendering was reused.
  std::size_t views_drawn = 0;
  std::size_t room_drawn = 0;  ///< static triangles drawn per view, on average; the others are out of sight
  std::size_t room_asked = 0;  ///< static triangles examined one by one by CyberRadar, over all queries
  std::size_t valid_px = 0;    ///< pixels with live depth
  std::size_t meshed_px = 0;   ///< pixels meshed: the dynamic ones with SurfacePolicy::kMap, otherwise all
                               ///< valid ones
  bool knows_moved = true;     ///< true only with SurfacePolicy::kMap
  std::size_t mesh_triangles = 0;
  CellCounts cells;  ///< cells of 4 x 4 pixels in the dynamic mesh; all 0 unless SurfacePolicy::kMap
};

}  // namespace roomradar
