// ray_hit.hpp: ray casting against a mesh, such as for the surface under the mouse pointer.
#pragma once
#include <Eigen/Geometry>
#include <optional>

#include "mapping/types/intrinsics.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

struct MeshHit {
  double distance_m = 0.0;  ///< from the ray's origin
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, facing the ray's origin
};

struct Ray {
  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_world = Eigen::Vector3d::UnitZ();  ///< unit
};

/// Returns the ray from the camera's centre through image coordinates (u, v). Integer coordinates are pixel
/// centres.
Ray ray_through(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, double u_px, double v_px);

/// Returns the nearest intersection of the ray with the mesh within reach_m. Both sides of triangles count.
/// Returns nullopt if there is none, if the mesh is null or empty, or if the ray is not finite or has no
/// direction. Source: Möller and Trumbore, Fast, minimum storage ray-triangle intersection, 1997, in double.
std::optional<MeshHit> hit_mesh(const TreeInstance& mesh, const Ray& ray, double reach_m);

}  // namespace roomradar
