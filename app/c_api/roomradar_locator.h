/* roomradar_locator.h: finds and follows the camera in a saved room, and renders the room's depth. No
 * objects, no picture: that is a session. */
#ifndef ROOMRADAR_LOCATOR_H
#define ROOMRADAR_LOCATOR_H

#include "roomradar_types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct roomradar_location {
  size_t struct_size;
  int32_t tracking;              /* a roomradar_tracking */
  roomradar_pose T_world_camera; /* the depth camera's, if tracked or degenerate */
  double rms_m;                  /* RMS distance of the inliers to the room, m; negative: none */
  double inlier_fraction;        /* 0..1 */
} roomradar_location;

ROOMRADAR_API roomradar_status roomradar_locator_open(const roomradar_map* map, roomradar_locator** locator);
ROOMRADAR_API roomradar_status roomradar_locator_close(roomradar_locator* locator);
/* Returns the sentence of the last failed call with this handle; see roomradar_map_error(). */
ROOMRADAR_API const char* roomradar_locator_error(const roomradar_locator* locator);
/* Localises a frame: follows the last frame's pose, or searches the map if there is none. Ignores the frame's
 * own pose. Returns ROOMRADAR_OK also if the camera is lost. */
ROOMRADAR_API roomradar_status roomradar_locator_locate(roomradar_locator* locator,
                                                        const roomradar_frame* frame,
                                                        roomradar_location* location);
/* Forgets the last pose, so that the next call searches the whole map. */
ROOMRADAR_API roomradar_status roomradar_locator_forget(roomradar_locator* locator);
/* Renders the depth of the saved room from any pose.
 * @param depth_m   height x width, m along the optical axis; 0: no surface
 * @param capacity  of depth_m, pixels
 * @param needed    width * height */
ROOMRADAR_API roomradar_status roomradar_locator_expected_depth(roomradar_locator* locator,
                                                                const roomradar_camera* camera,
                                                                const roomradar_pose* T_world_camera,
                                                                float* depth_m, size_t capacity,
                                                                size_t* needed);

#ifdef __cplusplus
}
#endif
#endif
