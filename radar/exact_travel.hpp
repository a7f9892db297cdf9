// exact_travel.hpp: the radar's judge: how far one mesh may move until it touches another, exactly.
#pragma once
#include <Eigen/Geometry>
#include <optional>

#include "mapping/types/mesh.hpp"

namespace roomradar {

enum class ExactMethod {
  kBruteForce,  ///< every triangle against every triangle
  kGrid,        ///< only those whose outlines across the direction share a grid cell; the same answer
};

/// Least travel t in [-slack_m, distance_m] at which `object`, moved by t along the direction, has a point in
/// common with `scene`: every vertex against every face, both ways, and every edge against every edge. The
/// meshes are surfaces, not solids: for an object that is free now this is the first contact; for one that
/// overlaps, the first crossing ahead.
///
/// Triangles with a vertex that is not finite are left out. Slow: for tests and benchmarks.
/// @return nothing if they do not meet within distance_m
/// @throws Error if direction is zero or not finite, or distance_m is not finite or negative
std::optional<double> exact_travel(const Mesh& object, const Eigen::Isometry3d& T_world_object,
                                   const Eigen::Vector3d& direction_world, double distance_m,
                                   const Mesh& scene, const Eigen::Isometry3d& T_world_scene,
                                   ExactMethod method = ExactMethod::kGrid, double slack_m = 0.0);

}  // namespace roomradar
