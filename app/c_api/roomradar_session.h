/* roomradar_session.h: augmented reality in a saved room: frames in; camera pose, dynamic surfaces and a
 * composed picture out. The saved map is not modified. */
#ifndef ROOMRADAR_SESSION_H
#define ROOMRADAR_SESSION_H

#include "roomradar_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Origin of the camera's pose. */
typedef enum roomradar_poses {
  ROOMRADAR_POSES_TRACKED = 0, /* found in the map, by depth and colour */
  ROOMRADAR_POSES_GIVEN = 1,   /* roomradar_frame::T_world_camera, in the map's world (an AR framework's) */
  ROOMRADAR_POSES_RECORDED = 2, /* the same, in the world of the recording that was scanned */
  ROOMRADAR_POSES_AUTO = 3 /* found in the map; roomradar_frame::T_world_camera, in any world, predicts the motion */
} roomradar_poses;

/* Surfaces that objects can touch. */
typedef enum roomradar_surfaces {
  ROOMRADAR_SURFACES_MAP = 0,   /* the saved room and dynamic surfaces */
  ROOMRADAR_SURFACES_HOLES = 1, /* the frame's depth alone, open where nothing was measured */
  ROOMRADAR_SURFACES_SKIRT = 2,
  ROOMRADAR_SURFACES_BORDER = 3
} roomradar_surfaces;

typedef struct roomradar_session_options {
  size_t struct_size;
  int32_t poses;            /* a roomradar_poses */
  int32_t surfaces;         /* a roomradar_surfaces */
  int32_t unknown_is_solid; /* 1: objects cannot enter unobserved space */
  int32_t has_no_picture;   /* 1: no picture is made; the engine draws */
  int32_t watches_changes;  /* 1: lasting changes of the room can be committed. Opens the map a second time */
  double adopt_after_s;   /* 0: changes are committed on request only; else after this time without motion */
  int32_t may_adopt_late; /* 1: a frame never waits for a change that is being committed */
  /* Settings that trade accuracy for time, by name: "depth_stride=2 radar=sampled". Names and values are
   * those of `roomradar run --help` and presets.json. Null: the defaults. */
  const char* quality;
} roomradar_session_options;

/* Opens a session. `options` may be null. The map's handle may be closed afterwards. */
ROOMRADAR_API roomradar_status roomradar_session_open(const roomradar_map* map,
                                                      const roomradar_session_options* options,
                                                      roomradar_session** session);
ROOMRADAR_API roomradar_status roomradar_session_close(roomradar_session* session);
/* Returns the sentence of the last failed call with this handle, "" if there is none. Valid until this
 * thread's next call of a function that returns a sentence. */
ROOMRADAR_API const char* roomradar_session_error(const roomradar_session* session);

typedef struct roomradar_frame_result {
  size_t struct_size;
  int32_t is_located;            /* 0: no camera pose; objects did not move */
  int32_t tracking;              /* a roomradar_tracking */
  roomradar_pose T_world_camera; /* the depth camera's, if located */
  int32_t picture_is_new;
  int32_t contacts;                                  /* impacts of objects in this frame */
  int32_t contacts_by_kind[ROOMRADAR_SURFACE_KINDS]; /* by roomradar_surface_kind */
  int32_t departures;       /* objects that fell out of the map and were returned or removed */
  int32_t notices;          /* sentences that wait in roomradar_session_notices() */
  uint64_t moved_pixels;    /* of the depth image, reduced by depth_stride */
  uint64_t moved_triangles; /* of the mesh of the dynamic surfaces */
  uint64_t room_version;    /* from 1; grows when the room's mesh changes */
  double frame_ms;          /* time of the whole frame */
  double contact_ms;        /* time until all objects had moved */
} roomradar_frame_result;

/* Processes one frame: locates the camera, finds dynamic pixels, moves the objects, composes the picture.
 * Returns ROOMRADAR_INVALID_ARGUMENT for an invalid frame, such as one without depth, and changes nothing.
 * `result` may be null. */
ROOMRADAR_API roomradar_status roomradar_session_step(roomradar_session* session,
                                                      const roomradar_frame* frame,
                                                      roomradar_frame_result* result);

/* Returns the standard deviations of the last frame's camera pose along the map's axes, and of its rotation
 * about them; inf: not known. Both are 0 without a pose.
 * @param sigma_m    m
 * @param sigma_rad  rad; may be null */
ROOMRADAR_API roomradar_status roomradar_session_pose_sigma(roomradar_session* session, double sigma_m[3],
                                                            double sigma_rad[3]);

/* Returns the picture with the objects.
 * @param rgb       height x width x 3, sRGB
 * @param capacity  of rgb, bytes
 * @param needed    width * height * 3; 0 before the first frame
 * @param width_px, height_px  may be null */
ROOMRADAR_API roomradar_status roomradar_session_picture(roomradar_session* session, uint8_t* rgb,
                                                         size_t capacity, size_t* needed, int32_t* width_px,
                                                         int32_t* height_px);
/* Returns camera and pose of the picture, for an engine that draws over it. FAILED if the last frame was not
 * located or no picture is made. */
ROOMRADAR_API roomradar_status roomradar_session_view(roomradar_session* session, roomradar_camera* camera,
                                                      roomradar_pose* T_world_view);
/* Takes the sentences about objects since the last call, one a line, such as that an object is stuck.
 * @param text    ends with 0
 * @param needed  bytes, with the 0; the sentences stay if the capacity is too small */
ROOMRADAR_API roomradar_status roomradar_session_notices(roomradar_session* session, char* text,
                                                         size_t capacity, size_t* needed);

/* From now on unobserved space is solid (1) or free (0). */
ROOMRADAR_API roomradar_status roomradar_session_set_unknown(roomradar_session* session, int32_t is_solid);
/* Changes the surfaces that objects can touch, from the next frame on. */
ROOMRADAR_API roomradar_status roomradar_session_set_surfaces(roomradar_session* session, int32_t surfaces);
/* Sets the quality; what the words do not name gets its default. */
ROOMRADAR_API roomradar_status roomradar_session_set_quality(roomradar_session* session, const char* quality);

#ifdef __cplusplus
}
#endif
#endif
