// exact_travel.hpp: reference for the radar: the distances along a direction over which one mesh touches
// another.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"
#include "tests/support/exact_gap.hpp"

namespace roomradar {

enum class ExactMethod {
  kBruteForce,  ///< tests every triangle against every triangle
  kGrid,        ///< tests only pairs whose outlines across the direction share a grid cell; same result
};

/// Returns the least t in [-slack_m, distance_m] at which `object`, moved by t along the direction, has a
/// point in common with `scene`. Tests every vertex against every face, both ways, and every edge against
/// every edge. The meshes are surfaces, not solids. For an object that is free now, the result is the first
/// contact; for one that overlaps, the first crossing ahead.
///
/// Triangles with a non-finite vertex are ignored. Slow: for tests and benchmarks.
/// @return nullopt if there is no contact within distance_m
/// @throws Error if direction is zero or not finite, or distance_m is not finite or negative
std::optional<double> exact_travel(const Mesh& object, const Eigen::Isometry3d& T_world_object,
                                   const Eigen::Vector3d& direction_world, double distance_m,
                                   const Mesh& scene, const Eigen::Isometry3d& T_world_scene,
                                   ExactMethod method = ExactMethod::kGrid, double slack_m = 0.0);

/// Returns all distances, backward and forward without limit, at which the two surfaces have a point in
/// common: the union of the intervals of all pairs of triangles, ascending. Empty if the object passes the
/// scene by.
/// @throws Error if direction is zero or not finite
std::vector<TravelSpan> exact_crossings(const Mesh& object, const Eigen::Isometry3d& T_world_object,
                                        const Eigen::Vector3d& direction_world, const Mesh& scene,
                                        const Eigen::Isometry3d& T_world_scene);

/// Returns the crossing that contains 0 in its interior, if any; the surfaces part after moving back by
/// -from_m.
std::optional<TravelSpan> exact_overlap(std::span<const TravelSpan> crossings);

}  // namespace roomradar
