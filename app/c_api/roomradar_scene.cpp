// roomradar_scene.cpp: a session's expected depth, dynamic surfaces, mesh blocks and changes.
#include "app/c_api/roomradar_scene.h"

#include <span>
#include <string>
#include <vector>

#include "app/c_api/conversions.hpp"
#include "app/c_api/session_state.hpp"
#include "mapping/map/changed_map.hpp"

using namespace roomradar;
using namespace roomradar::c_api;

namespace {

/// Returns the room's blocks, renewed if the room has changed.
const RoomBlocks& blocks_of(SessionState& state) {
  if (state.blocks_revision != state.room_revision) {
    state.blocks = room_blocks(state.session->room_mesh(), state.blocks);
    state.blocks_revision = state.room_revision;
  }
  return state.blocks;
}

void require_watching(const SessionState& state) {
  if (!state.own_map)
    throw Refusal(
        ROOMRADAR_FAILED,
        "the session commits no changes; open it with roomradar_session_options::watches_changes = 1");
}

}  // namespace

roomradar_status roomradar_session_expected_depth(roomradar_session* session, float* depth_m, size_t capacity,
                                                  size_t* needed, roomradar_camera* camera) {
  return with<SessionState>("roomradar_session_expected_depth", session, [&](SessionState& state) {
    const ExpectedView& expected = state.session->scene().expected();
    const bool is_there = state.located_frames > 0;
    if (camera != nullptr && is_there) *camera = camera_of(expected.camera);
    write_array(
        std::span<const float>(expected.depth_m.pixels).first(is_there ? expected.depth_m.pixels.size() : 0),
        depth_m, capacity, needed);
  });
}

roomradar_status roomradar_session_moved_mask(roomradar_session* session, uint8_t* mask, size_t capacity,
                                              size_t* needed, int32_t* width_px, int32_t* height_px) {
  return with<SessionState>("roomradar_session_moved_mask", session, [&](SessionState& state) {
    const MaskImage& moved = state.session->scene().foreground().dynamic_mask;
    if (width_px != nullptr) *width_px = moved.width;
    if (height_px != nullptr) *height_px = moved.height;
    require_capacity(mask, capacity, moved.pixels.size(), needed);
    for (std::size_t i = 0; i < moved.pixels.size(); ++i) mask[i] = moved.pixels[i] != 0 ? 255 : 0;
  });
}

roomradar_status roomradar_session_moved_mesh(roomradar_session* session, int32_t is_back,
                                              roomradar_mesh_buffers* mesh) {
  return with<SessionState>("roomradar_session_moved_mesh", session, [&](SessionState& state) {
    const DynamicSurface& moved = state.session->scene().dynamic_world();
    write_mesh(is_back != 0 ? moved.inferred_world : moved.seen_world, state.located_frames, mesh);
  });
}

roomradar_status roomradar_session_blocks(roomradar_session* session, roomradar_block* blocks,
                                          size_t capacity, size_t* needed) {
  return with<SessionState>("roomradar_session_blocks", session, [&](SessionState& state) {
    write_blocks(blocks_of(state), blocks, capacity, needed);
  });
}

roomradar_status roomradar_session_block_mesh(roomradar_session* session, uint64_t block_id,
                                              roomradar_mesh_buffers* mesh) {
  return with<SessionState>("roomradar_session_block_mesh", session, [&](SessionState& state) {
    write_block_mesh(state.session->room_mesh(), blocks_of(state), block_id, mesh);
  });
}

roomradar_status roomradar_session_adopt(roomradar_session* session) {
  return with<SessionState>("roomradar_session_adopt", session, [&](SessionState& state) {
    require_watching(state);
    state.run([](Session& live) { live.commit_changes(); });
  });
}

roomradar_status roomradar_session_changes(roomradar_session* session, roomradar_change* changes,
                                           size_t capacity, size_t* needed) {
  return with<SessionState>("roomradar_session_changes", session, [&](SessionState& state) {
    const std::vector<CommittedChange> committed = state.session->committed_changes();
    require_capacity(changes, capacity, committed.size(), needed);
    for (const CommittedChange& change : committed) {
      roomradar_change& to = *changes++;
      to.is_removal = change.kind == LastingKind::kCame ? 0 : 1;
      to.frame = change.frame;
      to.stamp_s = change.stamp_s;
      write_vector(change.box_world.min(), to.min_world_m);
      write_vector(change.box_world.max(), to.max_world_m);
    }
  });
}

roomradar_status roomradar_session_save(roomradar_session* session, const char* folder) {
  return with<SessionState>("roomradar_session_save", session, [&](SessionState& state) {
    const std::string to = text_of(folder, "folder");
    require_watching(state);
    require_can_become_map(to, {});
    state.run([&](Session& live) {
      live.finish_commits();
      save_changed_map(*state.own_map, live.committed_changes().size(), to);
    });
  });
}
