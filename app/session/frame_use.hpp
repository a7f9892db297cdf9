// frame_use.hpp: how much of the room and of the depth image a frame needed.
#pragma once
#include <cstddef>

#include "dynamic/surface/dynamic_cells.hpp"

namespace roomradar {

/// Of one frame that was located.
struct FrameUse {
  std::size_t room_triangles = 0;  ///< of the static mesh
  /// Views of it that were drawn, to find the camera and to know the depth it expects; 0: the camera stands,
  /// and what was drawn before was kept.
  std::size_t views_drawn = 0;
  std::size_t room_drawn = 0;  ///< its triangles in a view, on average; the others are out of sight
  std::size_t room_asked = 0;  ///< its triangles that CyberRadar looked at one by one, in all queries
  std::size_t valid_px = 0;    ///< pixels with live depth
  std::size_t meshed_px = 0;   ///< of these, those that moved; without a map's surfaces all
  bool knows_moved = true;     ///< false without a map's surfaces
  std::size_t mesh_triangles = 0;
  CellCounts cells;  ///< of 4 x 4 pixels, of the mesh of what moved; without a map's surfaces none
};

}  // namespace roomradar
