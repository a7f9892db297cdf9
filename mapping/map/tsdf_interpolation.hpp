// tsdf_interpolation.hpp: interpolates signed distances between voxel centres.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "mapping/octree/static_map.hpp"

namespace roomradar {

/// Signed distance and its gradient at a point, interpolated trilinearly from the eight samples around the
/// point. distance_at() returns nullopt if one of the eight samples is unknown.
struct DistanceAt {
  double distance_m = 0.0;  ///< m, along the viewing rays, as in SurfaceSample
  /// Points in the direction of growing distance: to the free side.
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};
std::optional<DistanceAt> distance_at(const StaticMap& map, const Eigen::Vector3d& p_world);

}  // namespace roomradar
