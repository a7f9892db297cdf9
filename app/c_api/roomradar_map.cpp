// roomradar_map.cpp: exported functions for saved maps.
#include "app/c_api/roomradar_map.h"

#include <utility>

#include "app/c_api/conversions.hpp"
#include "app/c_api/handles.hpp"
#include "mapping/mesh/mesh_blocks.hpp"

using namespace roomradar;
using namespace roomradar::c_api;

namespace {

const RoomBlocks& blocks_of(MapState& map) {
  if (!map.blocks) map.blocks = room_blocks(map.map.mesh);
  return *map.blocks;
}

}  // namespace

roomradar_status roomradar_map_open(const char* folder, roomradar_map** map) {
  return guarded("roomradar_map_open", nullptr, [&] {
    require_given(map, "map");
    auto state = std::make_shared<MapState>();
    state->folder = text_of(folder, "folder");
    state->map = load_map(state->folder);
    *map = HandleTable<MapState>::get().add<roomradar_map>(std::move(state));
  });
}

roomradar_status roomradar_map_close(roomradar_map* map) {
  return c_api::close<MapState>("roomradar_map_close", map);
}

const char* roomradar_map_error(const roomradar_map* map) { return error_of<MapState>(map); }

roomradar_status roomradar_map_describe(const roomradar_map* map, roomradar_map_info* info) {
  return with<MapState>("roomradar_map_describe", map, [&](MapState& state) {
    require_struct(info, "info");
    const MapInfo& from = state.map.info;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& vertex : state.map.mesh.vertices)
      box.extend(state.map.mesh.origin + vertex.cast<double>());
    info->format_version = from.format_version;
    info->resolution_m = from.resolution_m;
    info->vertices = from.vertices;
    info->triangles = from.triangles;
    info->keyframes = from.keyframes;
    write_vector(box.isEmpty() ? Eigen::Vector3d::Zero() : box.min(), info->min_world_m);
    write_vector(box.isEmpty() ? Eigen::Vector3d::Zero() : box.max(), info->max_world_m);
    info->is_up_known = from.up_source != "none" ? 1 : 0;
    info->T_world_recorded = pose_of(from.T_world_recorded);
  });
}

roomradar_status roomradar_map_blocks(const roomradar_map* map, roomradar_block* blocks, size_t capacity,
                                      size_t* needed) {
  return with<MapState>("roomradar_map_blocks", map,
                        [&](MapState& state) { write_blocks(blocks_of(state), blocks, capacity, needed); });
}

roomradar_status roomradar_map_block_mesh(const roomradar_map* map, uint64_t block_id,
                                          roomradar_mesh_buffers* mesh) {
  return with<MapState>("roomradar_map_block_mesh", map, [&](MapState& state) {
    write_block_mesh(state.map.mesh, blocks_of(state), block_id, mesh);
  });
}

roomradar_status roomradar_map_occupancy(const roomradar_map* map, const double* points_world_m, size_t count,
                                         uint8_t* occupancy) {
  return with<MapState>("roomradar_map_occupancy", map, [&](MapState& state) {
    if (count == 0) return;
    require_given(points_world_m, "points_world_m");
    require_given(occupancy, "occupancy");
    const StaticMap& octree = state.map.octree.load();
    for (size_t i = 0; i < count; ++i) {
      const double* p = points_world_m + 3 * i;
      occupancy[i] = static_cast<uint8_t>(octree.occupancy_at({p[0], p[1], p[2]}));
    }
  });
}

roomradar_status roomradar_map_shape(const roomradar_map* map, roomradar_shape** shape) {
  return with<MapState>("roomradar_map_shape", map, [&](MapState& state) {
    require_given(shape, "shape");
    if (!state.shape) {
      auto made = std::make_shared<ShapeState>();
      made->tree.build_by_place(state.map.mesh);
      state.shape = std::move(made);
    }
    *shape = HandleTable<ShapeState>::get().add<roomradar_shape>(state.shape);
  });
}
