// map_diff.hpp: finds objects that appeared in a room, or vanished from it, between two maps.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "mapping/octree/static_map.hpp"

namespace roomradar {

enum class ChangeKind { kAppeared, kVanished };
std::string_view to_string(ChangeKind kind);

/// An object in one map, at a place that is free space in the other.
struct Change {
  ChangeKind kind = ChangeKind::kAppeared;
  Eigen::Vector3d position_world =
      Eigen::Vector3d::Zero();    ///< centroid of its surface, in the first map's world
  Eigen::AlignedBox3d box_world;  ///< bounds of its surface
  double area_m2 = 0.0;           ///< area of its observed surface; two sides of a voxel count once
  /// Part of the box that is free in the map without the object and not free in the map with it; includes the
  /// object's unobserved interior.
  double volume_m3 = 0.0;
  std::vector<Eigen::Vector3d> surface_world;  ///< centres of its voxels
};

struct DiffConfig {
  /// Surface counts as clear if the other map is free around it up to this distance and to clearance_voxels.
  /// The rest of an object, down to its support, may be as near as one voxel to other surfaces.
  double clearance_m = 0.045;
  double clearance_voxels = 3.0;
  double min_area_m2 = 3.6e-3;  ///< min clear surface of one object: 6 x 6 cm
  double min_size_m = 0.05;     ///< min extent of its clear surface
  /// Max pose error: an object that the other map has in the same shape, shifted by at most this, was not
  /// moved.
  double max_pose_error_m = 0.06;
  double min_same_shape = 0.7;  ///< min fraction of its surface that then coincides
};
/// Throws Error naming field, value and rule.
void require_valid(const DiffConfig& config);

/// Returns the changes, largest first. Regions that one of the maps does not know are unchanged. Not
/// detected are objects smaller than the clearance, and objects that moved, or stand out from a plane, by
/// less than max_pose_error_m.
/// @param T_a_b  from b's world to a's
std::vector<Change> diff_maps(const StaticMap& a, const StaticMap& b, const Eigen::Isometry3d& T_a_b,
                              const DiffConfig& config = {});

}  // namespace roomradar
