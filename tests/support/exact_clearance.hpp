// exact_clearance.hpp: reference for poses: exact distance between two meshes, and whether one encloses the
// other.
#pragma once
#include <Eigen/Geometry>
#include <limits>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns the least distance between the two surfaces, 0 if they cross. Returns at_most_m if the distance is
/// not less, or if a mesh is empty. Compares every triangle with every other. Triangles with a non-finite
/// vertex are ignored. Slow: for tests.
double exact_clearance(const Mesh& object, const Eigen::Isometry3d& T_world_object, const Mesh& scene,
                       const Eigen::Isometry3d& T_world_scene,
                       double at_most_m = std::numeric_limits<double>::infinity());

/// Returns true if the closed mesh winds around the point an odd number of times. All triangles must face
/// outwards or all inwards. Sums solid angles, so no ray can graze an edge. For a point on the surface the
/// result may be either. Source: van Oosterom and Strackee, The solid angle of a plane triangle, IEEE TBME
/// 1983, equation (8).
bool exact_encloses(const Mesh& closed, const Eigen::Isometry3d& T_world_mesh,
                    const Eigen::Vector3d& point_world);

/// Returns true if any scene vertex that a triangle uses is inside the closed object.
bool exact_holds_inside(const Mesh& closed_object, const Eigen::Isometry3d& T_world_object, const Mesh& scene,
                        const Eigen::Isometry3d& T_world_scene);

}  // namespace roomradar
