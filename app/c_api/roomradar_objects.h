/* roomradar_objects.h: virtual objects of a session and their physics. Objects have names, 1 to 255 bytes.
 * They move in roomradar_session_step(). */
#ifndef ROOMRADAR_OBJECTS_H
#define ROOMRADAR_OBJECTS_H

#include "roomradar_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Material of a body. Unset values (0 in the mask) keep what they were, at first the session's. */
typedef struct roomradar_material {
  size_t struct_size;
  uint32_t is_set;      /* sum of ROOMRADAR_SETS_ values */
  double mass_kg;       /* 0.0001..10000 */
  double density_kg_m3; /* 1..30000, instead of a mass, for closed meshes */
  double friction;      /* Coulomb's coefficient, 0..10 */
  double restitution;   /* 0..1 */
} roomradar_material;
#define ROOMRADAR_SETS_MASS 1u
#define ROOMRADAR_SETS_DENSITY 2u
#define ROOMRADAR_SETS_FRICTION 4u
#define ROOMRADAR_SETS_RESTITUTION 8u

/* Adds an object, outside the room until it is placed or dropped.
 * @param file      "teapot", or a .glb, .gltf, .obj, .ply, .stl or .dae file
 * @param size_m    longest side after scaling; 0: not scaled
 * @param material  may be null */
ROOMRADAR_API roomradar_status roomradar_session_add_file(roomradar_session* session, const char* name,
                                                          const char* file, double size_m,
                                                          const roomradar_material* material);
/* Adds an object of a mesh in the object's frame, +z up, m. Large meshes take some time. */
ROOMRADAR_API roomradar_status roomradar_session_add_mesh(roomradar_session* session, const char* name,
                                                          const roomradar_mesh* mesh,
                                                          const roomradar_material* material);
ROOMRADAR_API roomradar_status roomradar_session_set_material(roomradar_session* session, const char* name,
                                                              const roomradar_material* material);

/* Puts an object into the room, at rest. An object that begins in a surface is moved out by at most 10 cm, or
 * refused. */
ROOMRADAR_API roomradar_status roomradar_session_place(roomradar_session* session, const char* name,
                                                       const roomradar_pose* T_world_object);
/* Puts an object into the room with a velocity (m/s, of the centre of mass) and an angular velocity (rad/s,
 * world axes; null: none). */
ROOMRADAR_API roomradar_status roomradar_session_throw(roomradar_session* session, const char* name,
                                                       const roomradar_pose* T_world_object,
                                                       const double velocity_world_mps[3],
                                                       const double angular_velocity_world_rad_s[3]);
/* Drops an object from a height of 0..100 m above a point. Without a point (null) it waits for a frame that
 * shows a level surface, and falls there. The lowest vertex begins at that height. */
ROOMRADAR_API roomradar_status roomradar_session_drop(roomradar_session* session, const char* name,
                                                      const double point_world_m[3], double height_m);
/* Moves an object towards a position and holds it until it is released. Obstacles stop it on the way. */
ROOMRADAR_API roomradar_status roomradar_session_carry(roomradar_session* session, const char* name,
                                                       const double position_world_m[3]);
/* Lets go of a carried object with a velocity, m/s. */
ROOMRADAR_API roomradar_status roomradar_session_release(roomradar_session* session, const char* name,
                                                         const double velocity_world_mps[3]);
/* Turns an object about its centre by a rotation vector in world axes, until the first contact. */
ROOMRADAR_API roomradar_status roomradar_session_turn(roomradar_session* session, const char* name,
                                                      const double turn_world_deg[3]);
/* Takes an object out of the room; its name stays in use. */
ROOMRADAR_API roomradar_status roomradar_session_remove(roomradar_session* session, const char* name);

typedef struct roomradar_object_state {
  int32_t is_in_room;
  int32_t is_asleep;
  int32_t is_carried;
  int32_t is_stuck;   /* a surface intersects it, and no free pose is near */
  int32_t rests_on;   /* kind of the surface below it, a roomradar_surface_kind */
  int32_t departures; /* times that it fell out of the map */
  double mass_kg;
  roomradar_pose T_world_object;
  double velocity_world_mps[3]; /* of the centre of mass */
  double angular_velocity_world_rad_s[3];
} roomradar_object_state;
/* Lists the states of all objects, in the order in which they were added. */
ROOMRADAR_API roomradar_status roomradar_session_objects(roomradar_session* session,
                                                         roomradar_object_state* states, size_t capacity,
                                                         size_t* needed);
/* Returns one object's state. */
ROOMRADAR_API roomradar_status roomradar_session_object(roomradar_session* session, const char* name,
                                                        roomradar_object_state* state);
/* Returns an object's name by its index in roomradar_session_objects().
 * @param needed  bytes, with the 0 at the end */
ROOMRADAR_API roomradar_status roomradar_session_object_name(roomradar_session* session, size_t index,
                                                             char* name, size_t capacity, size_t* needed);
/* Returns an object's mesh in its own frame. Textures are not returned. Its version is always 1. */
ROOMRADAR_API roomradar_status roomradar_session_object_mesh(roomradar_session* session, const char* name,
                                                             roomradar_mesh_buffers* mesh);

/* A point where an object touches something. */
typedef struct roomradar_touch {
  double point_world[3];  /* on the other surface, m */
  double normal_world[3]; /* unit, from there to the object */
  double gap_m;           /* >= 0 */
  int32_t kind;           /* a roomradar_surface_kind */
  int32_t other;          /* index of the other object; -1: a surface */
} roomradar_touch;
/* Lists the points where an object in the room touches something. */
ROOMRADAR_API roomradar_status roomradar_session_touches(roomradar_session* session, const char* name,
                                                         roomradar_touch* touches, size_t capacity,
                                                         size_t* needed);

#ifdef __cplusplus
}
#endif
#endif
