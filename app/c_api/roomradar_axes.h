/* roomradar_axes.h: converts points, poses and cameras to the axes and units of engines, and back.
 *
 * All conversions keep the map's forward (+y), right (+x) and up (+z). For Godot and glTF (x, y, z) becomes
 * (x, z, -y), for Unity (x, z, y), for Unreal (100 y, 100 x, 100 z). Meshes are converted by
 * roomradar_mesh_buffers::axes, which also orders triangles as the engine's front faces. */
#ifndef ROOMRADAR_AXES_H
#define ROOMRADAR_AXES_H

#include "roomradar_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Converts positions or velocities, count x 3, from the world (m) to an engine. In place is allowed. */
ROOMRADAR_API roomradar_status roomradar_points_to_engine(int32_t axes, const double* points_world_m,
                                                          double* points_engine, size_t count);
/* Converts positions or velocities back to the world, m. */
ROOMRADAR_API roomradar_status roomradar_points_from_engine(int32_t axes, const double* points_engine,
                                                            double* points_world_m, size_t count);
/* Converts the pose of an object whose mesh is in the engine's axes as well. */
ROOMRADAR_API roomradar_status roomradar_pose_to_engine(int32_t axes, const roomradar_pose* T_world_object,
                                                        roomradar_pose* T_engine_object);
ROOMRADAR_API roomradar_status roomradar_pose_from_engine(int32_t axes, const roomradar_pose* T_engine_object,
                                                          roomradar_pose* T_world_object);
/* Converts the pose of a camera to that of an engine's camera node. Godot's and glTF's look along -z with y
 * up, Unity's along z with y up, Unreal's along x with z up. */
ROOMRADAR_API roomradar_status roomradar_camera_to_engine(int32_t axes, const roomradar_pose* T_world_camera,
                                                          roomradar_pose* T_engine_camera);
ROOMRADAR_API roomradar_status roomradar_camera_from_engine(int32_t axes,
                                                            const roomradar_pose* T_engine_camera,
                                                            roomradar_pose* T_world_camera);
/* Returns the unit quaternion x, y, z, w of a pose's rotation, w >= 0. In left-handed axes it is that of the
 * engine. */
ROOMRADAR_API roomradar_status roomradar_quaternion(const roomradar_pose* pose, double q_xyzw[4]);
/* Returns the vertical field of view, rad, of a camera whose principal point is in the image's middle. */
ROOMRADAR_API roomradar_status roomradar_vertical_fov(const roomradar_camera* camera, double* fov_rad);

#ifdef __cplusplus
}
#endif
#endif
