// surface_points.hpp: samples points on the surface of a map, from its mesh or from its keyframes.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns `count` points sampled uniformly on a mesh. Deterministic. Empty for a mesh without area.
std::vector<Eigen::Vector3d> sample_surface(const Mesh& mesh, std::size_t count);

/// Returns at most `count` surface points from the keyframes' depth previews (downsampled depth images), in
/// the keyframes' world frame. Uses depths up to 3 m, and one point per cube of 3 cm, so that what many
/// keyframes show does not count more.
std::vector<Eigen::Vector3d> surface_of(const KeyframeDatabase& keyframe_database, std::size_t count);

}  // namespace roomradar
