// exact_travel.hpp: the radar's judge: at which travels along a direction does one mesh touch another?
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"
#include "tests/support/exact_gap.hpp"

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

/// All travels, back and ahead without end, at which the two surfaces have a point in common: the spans of
/// all pairs of triangles, ascending, those that meet made one. Empty where the object passes by.
/// @throws Error if direction is zero or not finite
std::vector<TravelSpan> exact_crossings(const Mesh& object, const Eigen::Isometry3d& T_world_object,
                                        const Eigen::Vector3d& direction_world, const Mesh& scene,
                                        const Eigen::Isometry3d& T_world_scene);

/// The crossing that holds travel 0 inside, if any: -from_m is how far back the surfaces part.
std::optional<TravelSpan> exact_overlap(std::span<const TravelSpan> crossings);

}  // namespace roomradar
