// map_diff.hpp: what appeared in a room and what vanished between two maps of it.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "mapping/octree/static_map.hpp"

namespace roomradar {

enum class ChangeKind { kAppeared, kVanished };
std::string_view to_string(ChangeKind kind);

/// One thing that is in one map, and where the other knows free space.
struct Change {
  ChangeKind kind = ChangeKind::kAppeared;
  Eigen::Vector3d position_world =
      Eigen::Vector3d::Zero();    ///< mean of its surface, in the first map's world
  Eigen::AlignedBox3d box_world;  ///< round its surface
  double area_m2 = 0.0;           ///< of its surface that was seen: two sides of a voxel count once
  /// Of the box, what was free and is so no more (or the other way round); holds what nobody saw behind the
  /// surface, the thing's inside.
  double volume_m3 = 0.0;
  std::vector<Eigen::Vector3d> surface_world;  ///< centres of its voxels
};

struct DiffConfig {
  /// A surface counts as new if the other map knows free space all round it this far, and so many voxels; the
  /// rest of the thing, down to what it stands on, may be as near as a voxel.
  double clearance_m = 0.045;
  double clearance_voxels = 3.0;
  double min_area_m2 = 3.6e-3;  ///< of such surface in one thing: 6 x 6 cm
  double min_size_m = 0.05;     ///< greatest extent of such surface
  /// What the other map has in the same shape, but so far aside at most, was not moved: the poses were off.
  double max_pose_error_m = 0.06;
  double min_same_shape = 0.7;  ///< of the thing's surface, the part that must then lie on the other's
};
/// Throws Error naming field, value and rule.
void require_valid(const DiffConfig& config);

/// The largest change first. Where one of the maps does not know what is there, nothing has changed. Not seen
/// are things smaller than the clearance, and those moved, or standing out from a plane, by less than
/// max_pose_error_m.
/// @param T_a_b  b's world to a's
std::vector<Change> diff_maps(const StaticMap& a, const StaticMap& b, const Eigen::Isometry3d& T_a_b,
                              const DiffConfig& config = {});

}  // namespace roomradar
