// frame_use.hpp: counts of the room's triangles and the depth pixels that a frame needed.
#pragma once
#include <cstddef>
#include <cstdint>

#include "app/session/frame_scene.hpp"
#include "app/session/session_room.hpp"
#include "dynamic/foreground/foreground.hpp"
#include "dynamic/surface/dynamic_cells.hpp"

namespace roomradar {

/// Counts for one localised frame.
struct FrameUse {
  std::size_t room_triangles = 0;  ///< all triangles of the static mesh
  /// Number of views of the static mesh rendered, to localise the camera and for the expected depth. 0: the
  /// camera was stationary, so an earlier rendering was reused.
  std::size_t views_drawn = 0;
  std::size_t room_drawn = 0;  ///< static triangles drawn per view, on average; the others are out of view
  std::size_t room_asked = 0;  ///< static triangles that CyberRadar examined individually, over all queries
  std::size_t valid_px = 0;    ///< pixels with live depth
  std::size_t meshed_px = 0;   ///< pixels meshed: the dynamic ones with SurfacePolicy::kMap, otherwise all
                               ///< valid ones
  bool knows_moved = true;     ///< dynamic pixels are known; true only with SurfacePolicy::kMap
  std::size_t mesh_triangles = 0;
  CellCounts cells;  ///< cells of 4 x 4 pixels in the dynamic mesh; all 0 unless SurfacePolicy::kMap
};

/// Returns the counts of the frame that the scene has just processed.
/// @param has_map           true with SurfacePolicy::kMap
/// @param drawn_before      scene.room_drawn() before the frame
/// @param triangles_tested  static triangles examined by the radar in this frame
FrameUse use_of(const SessionRoom& room, const FrameScene& scene, bool has_map,
                const ForegroundCounts& foreground, const FrameScene::RoomDrawn& drawn_before,
                std::uint64_t triangles_tested);

}  // namespace roomradar
