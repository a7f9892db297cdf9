/* roomradar_radar.h: Cyber Radar: how far a shape can move along a line before it touches a scene of shapes.
 * Runs on the processor, without OpenGL. */
#ifndef ROOMRADAR_RADAR_H
#define ROOMRADAR_RADAR_H

#include "roomradar_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Makes a shape of a mesh. Immutable: radars and threads may share it. */
ROOMRADAR_API roomradar_status roomradar_shape_open(const roomradar_mesh* mesh, roomradar_shape** shape);
/* Closes the handle. Radars whose scene holds the shape keep it. */
ROOMRADAR_API roomradar_status roomradar_shape_close(roomradar_shape* shape);

typedef struct roomradar_radar_options {
  size_t struct_size;
  int32_t is_sampled;    /* 0: exact; 1: stops early and returns bounds about a pixel apart */
  int32_t resolution_px; /* pixels along the object's longer side, 1..4096; 0: 64 */
} roomradar_radar_options;

/* Makes a radar with an empty scene. `options` may be null. */
ROOMRADAR_API roomradar_status roomradar_radar_open(const roomradar_radar_options* options,
                                                    roomradar_radar** radar);
ROOMRADAR_API roomradar_status roomradar_radar_close(roomradar_radar* radar);
/* Returns the sentence of the last failed call with this handle; see roomradar_map_error(). */
ROOMRADAR_API const char* roomradar_radar_error(const roomradar_radar* radar);

/* A shape in a scene. */
typedef struct roomradar_placed_shape {
  const roomradar_shape* shape;
  roomradar_pose T_world_shape;
  int32_t kind; /* a roomradar_surface_kind except ROOMRADAR_SURFACE_NOTHING */
} roomradar_placed_shape;
/* Replaces the scene. */
ROOMRADAR_API roomradar_status roomradar_radar_set_scene(roomradar_radar* radar,
                                                         const roomradar_placed_shape* shapes, size_t count);

typedef struct roomradar_query {
  roomradar_pose T_world_object; /* pose of the moving shape */
  double direction_world[3];     /* of motion, any length except 0 */
  double distance_m;             /* to search, > 0 */
  double margin_m;               /* inflates the shape, >= 0; if > 0, only lower_m is meaningful */
} roomradar_query;

typedef enum roomradar_contact_status {
  ROOMRADAR_CONTACT_INVALID = 0, /* the query: direction 0, distance <= 0, a pose that is not rigid, NaN */
  ROOMRADAR_CONTACT_NO_ANSWER = 1,
  ROOMRADAR_CONTACT_NONE = 2,    /* no contact within distance_m */
  ROOMRADAR_CONTACT_TOUCHES = 3, /* contact after travel_m >= 0 */
  ROOMRADAR_CONTACT_OVERLAP = 4  /* overlaps now; clear after moving back by -travel_m */
} roomradar_contact_status;

typedef struct roomradar_contact {
  int32_t status;         /* a roomradar_contact_status */
  int32_t kind;           /* the touched surface, a roomradar_surface_kind */
  double travel_m;        /* distance to contact; only with TOUCHES and OVERLAP */
  double lower_m;         /* lower bound of the true distance; without contact, what is certainly free */
  double upper_m;         /* upper bound; infinite without contact */
  double point_world[3];  /* on the scene's surface */
  double normal_world[3]; /* of the scene's surface, unit, towards the shape */
} roomradar_contact;

/* Queries the scene. An invalid query is ROOMRADAR_CONTACT_INVALID in its contact, and the call returns
 * ROOMRADAR_OK, so that one bad entry does not lose a batch. */
ROOMRADAR_API roomradar_status roomradar_radar_query(roomradar_radar* radar, const roomradar_shape* object,
                                                     const roomradar_query* query,
                                                     roomradar_contact* contact);
/* Queries the scene `count` times.
 * @param queries, contacts  count entries each */
ROOMRADAR_API roomradar_status roomradar_radar_query_many(roomradar_radar* radar,
                                                          const roomradar_shape* object,
                                                          const roomradar_query* queries, size_t count,
                                                          roomradar_contact* contacts);
/* Queries a session's scene of the last frame: room, dynamic surfaces, unknown space if solid, and all
 * objects. Exact. */
ROOMRADAR_API roomradar_status roomradar_session_query_shape(roomradar_session* session,
                                                             const roomradar_shape* object,
                                                             const roomradar_query* queries, size_t count,
                                                             roomradar_contact* contacts);
/* Queries a session's scene for one of its objects, which is not an obstacle to itself. The object need not
 * be in the room, and does not move. */
ROOMRADAR_API roomradar_status roomradar_session_query_object(roomradar_session* session, const char* name,
                                                              const roomradar_query* queries, size_t count,
                                                              roomradar_contact* contacts);

#ifdef __cplusplus
}
#endif
#endif
