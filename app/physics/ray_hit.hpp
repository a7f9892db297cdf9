// ray_hit.hpp: ray casting against a mesh, e.g. to find the surface under the mouse pointer.
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

/// Returns the ray from the camera through image coordinates (u, v); pixel (0, 0) has its centre at (0, 0).
Ray ray_through(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, double u_px, double v_px);

/// Returns the first triangle that the ray hits, on either side, within reach_m. Returns nothing for a null
/// or empty mesh, or a ray that is not finite. Source: Möller and Trumbore, Fast, minimum storage
/// ray-triangle intersection, 1997, in double.
std::optional<MeshHit> hit_mesh(const TreeInstance& mesh, const Ray& ray, double reach_m);

}  // namespace roomradar
