// exact_clearance.hpp: the judge of a pose: how far apart are two meshes, and does one hold the other inside?
#pragma once
#include <Eigen/Geometry>
#include <limits>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Least distance between the two surfaces, 0 where they cross; at_most_m where it is not less than that, or
/// where a mesh is empty. Every triangle against every other. Triangles with a vertex that is not finite are
/// left out. Slow: for tests.
double exact_clearance(const Mesh& object, const Eigen::Isometry3d& T_world_object, const Mesh& scene,
                       const Eigen::Isometry3d& T_world_scene,
                       double at_most_m = std::numeric_limits<double>::infinity());

/// Whether a closed mesh, its triangles all turned outwards or all inwards, goes round the point an odd
/// number of times, by the solid angle it fills: no ray that could graze an edge. A point on the surface:
/// either. Source: van Oosterom and Strackee, The solid angle of a plane triangle, IEEE TBME 1983, equation
/// (8).
bool exact_encloses(const Mesh& closed, const Eigen::Isometry3d& T_world_mesh,
                    const Eigen::Vector3d& point_world);

/// Whether any vertex of the scene that a triangle uses lies inside the closed object.
bool exact_holds_inside(const Mesh& closed_object, const Eigen::Isometry3d& T_world_object, const Mesh& scene,
                        const Eigen::Isometry3d& T_world_scene);

}  // namespace roomradar
