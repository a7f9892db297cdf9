/* roomradar_types.h: what all parts of the C API share: status, errors, poses, cameras, frames, meshes. */
#ifndef ROOMRADAR_TYPES_H
#define ROOMRADAR_TYPES_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define ROOMRADAR_API __attribute__((visibility("default")))
#else
#define ROOMRADAR_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct roomradar_map roomradar_map;         /* a saved room */
typedef struct roomradar_source roomradar_source;   /* a recording */
typedef struct roomradar_session roomradar_session; /* augmented reality in a saved room */
typedef struct roomradar_locator roomradar_locator; /* finds the camera in a saved room */
typedef struct roomradar_shape roomradar_shape;     /* a mesh that can be touched */
typedef struct roomradar_radar roomradar_radar;     /* distance to contact in a scene of shapes */

typedef enum roomradar_status {
  ROOMRADAR_OK = 0,
  ROOMRADAR_INVALID_ARGUMENT = 1,  /* null, NaN, out of range, or a name that does not exist */
  ROOMRADAR_CLOSED_HANDLE = 2,     /* closed, null, or of another kind */
  ROOMRADAR_WRONG_STRUCT_SIZE = 3, /* struct_size is not set, or of a header of another version */
  ROOMRADAR_BUFFER_TOO_SMALL = 4,  /* the needed count was set */
  ROOMRADAR_FAILED = 5,            /* file, map, renderer or settings; the sentence says what to do */
  ROOMRADAR_OUT_OF_MEMORY = 6,
  ROOMRADAR_END = 7,     /* a recording has no more frames */
  ROOMRADAR_SKIPPED = 8, /* a recording's frame is unreadable and was skipped; continue with the next */
  ROOMRADAR_INTERNAL = 9 /* a fault of the library */
} roomradar_status;

/* Returns the version of the library, such as "0.1.0". */
ROOMRADAR_API const char* roomradar_version(void);
/* Returns a status' name, such as "closed handle"; "unknown status" for other numbers. */
ROOMRADAR_API const char* roomradar_status_name(int32_t status);
/* Returns the sentence of the last call on this thread that failed; "" if none has. Valid until the thread's
 * next call that fails. For functions that open something, this is the only place of the sentence. */
ROOMRADAR_API const char* roomradar_last_error(void);

/* A rigid motion as a 4 x 4 matrix, row by row: m[3], m[7] and m[11] are the translation, the last row is
 * 0 0 0 1. A rotation may be wrong by 1e-6 per entry of R^T R - 1. */
typedef struct roomradar_pose {
  double m[16];
} roomradar_pose;

/* Pinhole camera without distortion: u = fx x / z + cx. Sizes 1..16384. */
typedef struct roomradar_camera {
  int32_t width_px, height_px;
  double fx_px, fy_px, cx_px, cy_px;
} roomradar_camera;

/* Standard deviation of a depth measurement: base + linear z + quadratic max(z - from, 0)^2, m. At grazing
 * angles a term with the factor `grazing` is added. All 0: a Kinect v1; otherwise base_m must be > 0. */
typedef struct roomradar_depth_noise {
  float base_m, linear, quadratic_per_m, from_m, grazing;
} roomradar_depth_noise;

/* Depth, colour, cameras and pose at one instant. The pointers are read during the call only. */
typedef struct roomradar_frame {
  size_t struct_size;
  int64_t index;  /* grows from frame to frame */
  double stamp_s; /* sensor time */
  roomradar_camera depth_camera;
  /* height x width, row by row, m along the optical axis. 0, negative or not finite: no measurement. */
  const float* depth_m;
  roomradar_camera colour_camera; /* unused without a colour image */
  const uint8_t* colour_rgb;      /* height x width x 3, sRGB; null: the frame has no colour */
  double colour_after_depth_s;    /* time of the colour image minus that of the depth image */
  roomradar_pose T_colour_depth;  /* depth camera to colour camera; all 0: the same place */
  int32_t has_pose;               /* 0: T_world_camera is unused */
  roomradar_pose T_world_camera;  /* depth camera; its world is that of roomradar_session_options::poses */
  int32_t has_gravity;            /* 0: down_camera is unused */
  double down_camera[3];          /* direction of gravity in the depth camera's frame, any length except 0 */
  roomradar_depth_noise noise;
  double depth_readout_s, colour_readout_s; /* time to read an image's rows, 0..1; 0: global shutter */
  double colour_delay_s;                    /* colour's delay beyond its stamp */
} roomradar_frame;

/* Axes and units of an engine; see roomradar_axes.h. */
typedef enum roomradar_axes {
  ROOMRADAR_AXES_WORLD = 0, /* this library's: right-handed, x right, y forward, z up, m */
  ROOMRADAR_AXES_GLTF = 1,  /* right-handed, x right, y up, z backward, m; triangles counter-clockwise */
  ROOMRADAR_AXES_GODOT = 2, /* as glTF, triangles clockwise */
  ROOMRADAR_AXES_UNITY = 3, /* left-handed, x right, y up, z forward, m; triangles clockwise */
  ROOMRADAR_AXES_UNREAL = 4 /* left-handed, x forward, y right, z up, cm; triangles counter-clockwise */
} roomradar_axes;

/* A mesh that the caller passes. Read during the call only. */
typedef struct roomradar_mesh {
  size_t struct_size;
  const float* vertices_m; /* vertex_count x 3, relative to origin_m; finite */
  size_t vertex_count;
  const uint32_t* triangles; /* triangle_count x 3 vertex indices, counter-clockwise from outside */
  size_t triangle_count;
  const uint8_t* colours_rgb; /* vertex_count x 3; null: grey */
  double origin_m[3];
} roomradar_mesh;

/* Buffers for a mesh that the library returns. Fields marked "in" are set by the caller, "out" by the
 * library. Vertex i is at origin + vertices[i]. */
typedef struct roomradar_mesh_buffers {
  size_t struct_size;
  int32_t axes;           /* in: a roomradar_axes; vertices, normals, origin and triangle order are in them */
  float* vertices;        /* in: vertex_capacity x 3 */
  float* normals;         /* in: vertex_capacity x 3, unit, outward; null: not wanted. 0 0 0: unknown */
  uint8_t* colours_rgb;   /* in: vertex_capacity x 3; null: not wanted. 128 128 128: unknown */
  size_t vertex_capacity; /* in */
  uint32_t* triangles;    /* in: triangle_capacity x 3 */
  size_t triangle_capacity; /* in */
  double origin[3];         /* out */
  size_t vertex_count;      /* out: also if the capacity is too small */
  size_t triangle_count;    /* out: also if the capacity is too small */
  uint64_t version;         /* out: changes when the mesh does */
} roomradar_mesh_buffers;

/* A block of the room's mesh: the triangles whose centroid is in one cube of 2 m. */
typedef struct roomradar_block {
  uint64_t id;           /* the cube: never changes for a place of the world */
  uint64_t version;      /* from 1; grows when the block's triangles change */
  double min_world_m[3]; /* bounding box of the vertices, m */
  double max_world_m[3];
  uint64_t vertex_count;
  uint64_t triangle_count; /* 0: all triangles of the block are gone */
} roomradar_block;

/* Result of a search for the camera. */
typedef enum roomradar_tracking {
  ROOMRADAR_TRACKED = 0,
  ROOMRADAR_TOO_FEW_POINTS = 1, /* lost */
  ROOMRADAR_DEGENERATE = 2,     /* a pose, partly predicted: not all directions are constrained */
  ROOMRADAR_DIVERGED = 3,       /* lost */
  ROOMRADAR_UNCERTAIN = 4       /* a guess that nothing has verified for more than 0.15 s */
} roomradar_tracking;

/* Kinds of surfaces that can be touched. */
typedef enum roomradar_surface_kind {
  ROOMRADAR_SURFACE_NOTHING = 0,
  ROOMRADAR_SURFACE_STATIC = 1,           /* the saved room */
  ROOMRADAR_SURFACE_DYNAMIC = 2,          /* a surface that is not in the map */
  ROOMRADAR_SURFACE_OBJECT = 3,           /* another virtual object */
  ROOMRADAR_SURFACE_UNKNOWN_FRONTIER = 4, /* frontier of unknown space */
  ROOMRADAR_SURFACE_INFERRED_BACK = 5     /* assumed back of a dynamic surface */
} roomradar_surface_kind;
#define ROOMRADAR_SURFACE_KINDS 6

#ifdef __cplusplus
}
#endif
#endif
