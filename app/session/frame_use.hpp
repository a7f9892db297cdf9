// frame_use.hpp: counts of the room triangles and depth pixels that one frame used.
#pragma once
#include <cstddef>
#include <cstdint>

#include "dynamic/foreground/foreground.hpp"
#include "dynamic/surface/dynamic_cells.hpp"

namespace roomradar {

class FrameScene;
struct SessionRoom;

/// Views of the room that a FrameScene rendered for the expected depth, and room triangles drawn in them.
struct RoomDrawn {
  std::size_t views = 0, triangles = 0;
};

/// Counts of one localised frame.
struct FrameUse {
  std::size_t room_triangles = 0;  ///< number of triangles of the static mesh
  /// Views of the static mesh rendered for localisation and expected depth. 0: an earlier rendering was
  /// reused because the camera was stationary.
  std::size_t views_drawn = 0;
  std::size_t room_drawn = 0;  ///< mean number of static triangles drawn per view; the others were culled
  /// Number of static triangles for which CyberRadar computed a bound from the triangle's plane, summed over
  /// all queries; see CyberRadar::static_triangles_tested().
  std::size_t room_asked = 0;
  std::size_t valid_px = 0;  ///< pixels with live depth
  /// Pixels meshed. SurfacePolicy::kMap: the dynamic pixels. Other policies: all valid pixels.
  std::size_t meshed_px = 0;
  /// True if dynamic pixels were detected. Only SurfacePolicy::kMap detects them.
  bool knows_moved = true;
  std::size_t mesh_triangles = 0;
  CellCounts cells;  ///< cells of 4 x 4 pixels of the dynamic mesh; all 0 unless SurfacePolicy::kMap
};

/// Returns the counts of the frame that `scene` processed last.
/// @param has_map           true with SurfacePolicy::kMap
/// @param drawn_before      scene.room_drawn() before the frame
/// @param triangles_tested  increase of CyberRadar::static_triangles_tested() in this frame
FrameUse use_of(const SessionRoom& room, const FrameScene& scene, bool has_map,
                const ForegroundCounts& foreground, const RoomDrawn& drawn_before,
                std::uint64_t triangles_tested);

}  // namespace roomradar
