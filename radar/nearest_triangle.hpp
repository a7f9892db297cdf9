// nearest_triangle.hpp: which triangle does a point lie on?
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>

#include "radar/gpu_mesh.hpp"

namespace roomradar {

struct NearestTriangle {
  double distance_m = 0.0;
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, by the winding
};

/// The instance's triangle nearest to a point, if one is within `within_m`. Of triangles that are equally
/// near (a shared edge) the one whose normal opposes `u_world` most. Triangles without area are left out. In
/// double precision; only chunks whose box is near are searched.
std::optional<NearestTriangle> nearest_triangle(const MeshInstance& instance, const Eigen::Vector3d& p_world,
                                                const Eigen::Vector3d& u_world, double within_m);

}  // namespace roomradar
