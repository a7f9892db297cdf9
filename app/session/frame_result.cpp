// frame_result.cpp: counts what a frame used.
#include "app/session/frame_result.hpp"

#include "app/session/frame_scene.hpp"
#include "app/session/session_room.hpp"

namespace roomradar {

FrameUse use_of(const SessionRoom& room, const FrameScene& scene, bool has_map,
                const ForegroundCounts& foreground, const RoomDrawn& drawn_before,
                std::uint64_t triangles_tested) {
  FrameUse use;
  use.room_triangles = room.shape.touched.triangle_count();
  use.views_drawn = scene.room_drawn().views - drawn_before.views;
  if (use.views_drawn > 0)
    use.room_drawn = (scene.room_drawn().triangles - drawn_before.triangles) / use.views_drawn;
  use.room_asked = static_cast<std::size_t>(triangles_tested);
  use.valid_px = foreground.valid;
  use.knows_moved = has_map;
  use.meshed_px = has_map ? foreground.moved : foreground.valid;
  use.mesh_triangles = scene.dynamic_triangles();
  if (has_map) use.cells = scene.dynamic_cells().counts;
  return use;
}

}  // namespace roomradar
