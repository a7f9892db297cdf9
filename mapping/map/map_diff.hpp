// map_diff.hpp: finds objects that appeared in a room, or vanished from it, between two maps.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "mapping/octree/static_map.hpp"

namespace roomradar {

enum class ChangeKind { kAppeared, kVanished };
std::string_view to_string(ChangeKind kind);

/// An object that is in one map, while the other map has free space there.
struct Change {
  ChangeKind kind = ChangeKind::kAppeared;
  Eigen::Vector3d position_world =
      Eigen::Vector3d::Zero();    ///< centroid of its surface, in the first map's world
  Eigen::AlignedBox3d box_world;  ///< bounding box of its surface, same world
  double area_m2 = 0.0;           ///< area of its observed surface; two sides of a voxel count once
  /// Volume, within the box, that is free in the map without the object but not in the map with it. Includes
  /// the object's unobserved interior.
  double volume_m3 = 0.0;
  std::vector<Eigen::Vector3d> surface_world;  ///< centres of its surface voxels, same world
};

struct DiffConfig {
  /// A surface voxel is clear if the other map is free around it up to this distance, and up to
  /// clearance_voxels. An object needs enough clear surface; its other surface, down to its support, may be
  /// one voxel from surfaces of the other map.
  double clearance_m = 0.045;
  double clearance_voxels = 3.0;
  double min_area_m2 = 3.6e-3;  ///< min clear surface of one object: 6 x 6 cm
  double min_size_m = 0.05;     ///< min extent of an object's clear surface
  /// Max error of T_a_b: if the other map has the same shape shifted by at most this, the object was not
  /// moved.
  double max_pose_error_m = 0.06;
  double min_same_shape = 0.7;  ///< min fraction of the shifted surface that must coincide
};
/// Throws Error naming field, value and rule.
void require_valid(const DiffConfig& config);

/// Returns the changes, largest first. Regions unknown in one of the maps count as unchanged, and
/// so does surface at which one map's scan ends. Objects smaller
/// than the clearance are not detected, nor are objects that moved, or stand out from a plane, by less than
/// max_pose_error_m.
/// @param T_a_b  maps points from b's world to a's world
std::vector<Change> diff_maps(const StaticMap& a, const StaticMap& b, const Eigen::Isometry3d& T_a_b,
                              const DiffConfig& config = {});

}  // namespace roomradar
