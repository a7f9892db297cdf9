/* roomradar_scene.h: what a session knows of the room: expected depth, dynamic pixels and surfaces, its
 * mesh in blocks, and changes that are committed and saved. */
#ifndef ROOMRADAR_SCENE_H
#define ROOMRADAR_SCENE_H

#include "roomradar_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Returns the room's depth as expected in the last located frame, from its pose.
 * @param depth_m   height x width, m; 0: no surface
 * @param capacity  of depth_m, pixels
 * @param needed    width * height; 0 before the first located frame
 * @param camera    of the image; may be null */
ROOMRADAR_API roomradar_status roomradar_session_expected_depth(roomradar_session* session, float* depth_m,
                                                                size_t capacity, size_t* needed,
                                                                roomradar_camera* camera);
/* Returns which pixels of the last located frame are dynamic, i.e. show a surface that is not in the map:
 * 255, else 0. The mask is of the depth image's size, divided by the quality's depth_stride.
 * @param capacity  of mask, pixels
 * @param needed    width * height; 0 before the first located frame
 * @param width_px, height_px  may be null */
ROOMRADAR_API roomradar_status roomradar_session_moved_mask(roomradar_session* session, uint8_t* mask,
                                                            size_t capacity, size_t* needed,
                                                            int32_t* width_px, int32_t* height_px);
/* Returns the mesh of the dynamic surfaces, in the world: the seen surfaces, or their assumed backs if
 * is_back is 1. Its version is the number of located frames. */
ROOMRADAR_API roomradar_status roomradar_session_moved_mesh(roomradar_session* session, int32_t is_back,
                                                            roomradar_mesh_buffers* mesh);
/* Lists the blocks of the room's present surface. Blocks that have vanished stay, with 0 triangles. Fetch
 * those whose version has grown; nothing has changed while roomradar_frame_result::room_version is the same.
 */
ROOMRADAR_API roomradar_status roomradar_session_blocks(roomradar_session* session, roomradar_block* blocks,
                                                        size_t capacity, size_t* needed);
ROOMRADAR_API roomradar_status roomradar_session_block_mesh(roomradar_session* session, uint64_t block_id,
                                                            roomradar_mesh_buffers* mesh);
/* A change of the room that was committed. */
typedef struct roomradar_change {
  int32_t is_removal; /* 0: something came; 1: something went */
  int64_t frame;      /* index of the first frame that used it */
  double stamp_s;
  double min_world_m[3], max_world_m[3]; /* bounds of what changed */
} roomradar_change;
/* Commits changes: objects that stand still in view and are not in the map, and objects that are gone.
 * Takes effect some frames later. Needs roomradar_session_options::watches_changes. */
ROOMRADAR_API roomradar_status roomradar_session_adopt(roomradar_session* session);
/* Lists the changes committed so far. */
ROOMRADAR_API roomradar_status roomradar_session_changes(roomradar_session* session,
                                                         roomradar_change* changes, size_t capacity,
                                                         size_t* needed);
/* Saves the room with the committed changes as a map, as `roomradar run --save-map` does. Waits for a change
 * that is being committed. A map in the folder is replaced, whole or not at all. Needs
 * roomradar_session_options::watches_changes. */
ROOMRADAR_API roomradar_status roomradar_session_save(roomradar_session* session, const char* folder);

#ifdef __cplusplus
}
#endif
#endif
