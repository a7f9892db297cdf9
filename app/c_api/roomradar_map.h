/* roomradar_map.h: a saved room. Immutable: sessions, locators and threads may share one handle. */
#ifndef ROOMRADAR_MAP_H
#define ROOMRADAR_MAP_H

#include "roomradar_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Opens the map in a folder that `roomradar prescan` or roomradar_session_save() wrote. Files are checked
 * before they are used; the octree is read when it is first needed. */
ROOMRADAR_API roomradar_status roomradar_map_open(const char* folder, roomradar_map** map);
/* Closes the handle. Sessions, locators and shapes made from the map stay usable. */
ROOMRADAR_API roomradar_status roomradar_map_close(roomradar_map* map);
/* Returns the sentence of the last failed call with this handle, "" if there is none. Valid until this
 * thread's next call of a function that returns a sentence. */
ROOMRADAR_API const char* roomradar_map_error(const roomradar_map* map);

typedef struct roomradar_map_info {
  size_t struct_size;
  int32_t format_version;
  double resolution_m; /* edge of the octree's smallest voxels */
  uint64_t vertices, triangles, keyframes;
  double min_world_m[3], max_world_m[3]; /* bounding box of the surface */
  int32_t is_up_known;                   /* 0: +z is up in the first camera's view only */
  roomradar_pose T_world_recorded; /* maps the world of the scanned recording's poses to the map's world */
} roomradar_map_info;
ROOMRADAR_API roomradar_status roomradar_map_describe(const roomradar_map* map, roomradar_map_info* info);

/* Lists the blocks of the saved surface, in a fixed order, all of version 1. `needed` may not be null. */
ROOMRADAR_API roomradar_status roomradar_map_blocks(const roomradar_map* map, roomradar_block* blocks,
                                                    size_t capacity, size_t* needed);
/* Returns one block's mesh, in the world or in an engine's axes. */
ROOMRADAR_API roomradar_status roomradar_map_block_mesh(const roomradar_map* map, uint64_t block_id,
                                                        roomradar_mesh_buffers* mesh);

typedef enum roomradar_occupancy {
  ROOMRADAR_OCCUPANCY_UNKNOWN = 0, /* never observed, outside the map, or a point that is not finite */
  ROOMRADAR_OCCUPANCY_FREE = 1,
  ROOMRADAR_OCCUPANCY_OCCUPIED = 2
} roomradar_occupancy;
/* Says for each of `count` points (count x 3, world, m) what is in its voxel.
 * @param occupancy  count entries, each a roomradar_occupancy */
ROOMRADAR_API roomradar_status roomradar_map_occupancy(const roomradar_map* map, const double* points_world_m,
                                                       size_t count, uint8_t* occupancy);

/* Makes a shape of the saved surface, for a radar. */
ROOMRADAR_API roomradar_status roomradar_map_shape(const roomradar_map* map, roomradar_shape** shape);

#ifdef __cplusplus
}
#endif
#endif
