// moved_things.hpp: which thing that vanished is one that appeared elsewhere, and how it was moved.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <vector>

#include "mapping/map/map_diff.hpp"
#include "mapping/octree/static_map.hpp"

namespace roomradar {

/// A thing that was carried: it vanished at one place and appeared at another, with the same shape.
struct MovedThing {
  std::size_t vanished = 0, appeared = 0;  ///< indices into the changes
  /// Maps its points from where it was to where it is, in the world frame of the changes. Its rotation is
  /// about z: a thing that stands somewhere else. A thing that looks the same after several turns was turned
  /// least.
  Eigen::Isometry3d T_now_before = Eigen::Isometry3d::Identity();
  double turned_deg = 0.0;  ///< about +z, -180 to 180
  double moved_m = 0.0;     ///< distance of its surface's middle before and now
  double same_shape = 0.0;  ///< fraction of its surface that coincides, of the side on which less does
};

/// Returns true if both maps have surface at a point, in the world frame of the changes.
using SharedSurface = std::function<bool(const Eigen::Vector3d& p_world)>;
/// @param T_b_a  from a's world frame, that of the changes, to b's. Both maps must outlive the result
SharedSurface surface_of_both(const StaticMap& a, const StaticMap& b, const Eigen::Isometry3d& T_b_a);

/// Returns the moved things, those that are most alike and moved least first. A change is part of at most
/// one. Two surfaces have one shape if, at the best place and turn, 55 % of each are within 3 cm of the
/// other, and 75 % of one of them: both scans saw a thing from some sides only. Things smaller than 20
/// surface points are not compared.
/// @param shared  tells where a thing that was moved by less than its size covers its own old place: there it
///                neither vanished nor appeared; null: nowhere
std::vector<MovedThing> find_moved_things(const std::vector<Change>& changes,
                                          const SharedSurface& shared = {});

}  // namespace roomradar
