// map_diff.hpp: finds objects that appeared in a room, or vanished from it, between two maps.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "mapping/octree/static_map.hpp"

namespace roomradar {

enum class ChangeKind { kAppeared, kVanished };
std::string_view to_string(ChangeKind kind);

/// An object that is in one map, while the other map has free space at its position.
struct Change {
  ChangeKind kind = ChangeKind::kAppeared;
  Eigen::Vector3d position_world =
      Eigen::Vector3d::Zero();    ///< centroid of its surface, in the world frame of map a
  Eigen::AlignedBox3d box_world;  ///< bounding box of its surface, in the world frame of map a
  double area_m2 = 0.0;           ///< area of its observed surface; two sides of a voxel count once
  /// Volume within the box that is free in the map without the object, and not free in the other map.
  /// Includes the object's unobserved interior.
  double volume_m3 = 0.0;
  std::vector<Eigen::Vector3d> surface_world;  ///< centres of its surface voxels, in the world frame of map a
};

struct DiffConfig {
  /// A surface voxel is clear if the other map is free within a radius around it. The radius is the larger of
  /// clearance_m and clearance_voxels, and twice as large for the voxels of coarse cells. Surface that is
  /// missing from the mesh, since too few frames measured it, is never clear. An object needs min_area_m2 of
  /// clear surface. The rest of its surface, down to its support, only has to be in the other map's free
  /// space.
  double clearance_m = 0.045;
  double clearance_voxels = 3.0;
  double min_area_m2 = 4.9e-3;  ///< min clear surface of an object: 7 x 7 cm
  double min_size_m = 0.05;     ///< min extent of an object's clear surface
  /// Max error of T_a_b, m. An object counts as unmoved if the other map has its shape, shifted by at most
  /// this.
  double max_pose_error_m = 0.06;
  double min_same_shape = 0.7;  ///< min fraction of the shifted surface that must coincide
};
/// Throws Error naming field, value and rule.
void require_valid(const DiffConfig& config);

/// Returns the changes, largest first. Regions that are unknown in one of the maps count as unchanged.
/// Surface at which one map's scan ends, and the roughness of surfaces measured from far away, count as
/// unchanged, too. Objects smaller than the clearance are not detected. Objects that moved by less than
/// max_pose_error_m, or protrude from a plane by less, are not detected either. A pole a few centimetres
/// thick that one scan measured only from beyond 3 m can be missing from that scan's map, and is then listed
/// as a change.
/// @param T_a_b  maps points from b's world frame to a's world frame
std::vector<Change> diff_maps(const StaticMap& a, const StaticMap& b, const Eigen::Isometry3d& T_a_b,
                              const DiffConfig& config = {});

/// Same, with the inverse of T_a_b given. With the maps in the other order, and both transforms exchanged,
/// the result is the same bit by bit, except that what appeared has vanished and that positions are in the
/// other world frame.
std::vector<Change> diff_maps(const StaticMap& a, const StaticMap& b, const Eigen::Isometry3d& T_a_b,
                              const Eigen::Isometry3d& T_b_a, const DiffConfig& config);

}  // namespace roomradar
