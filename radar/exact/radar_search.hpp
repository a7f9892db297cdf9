// radar_search.hpp: state of one CyberRadar query. Private to CyberRadar.
#pragma once
#include <Eigen/Geometry>

#include "radar/exact/contact_patch.hpp"
#include "radar/exact/overlap_depth.hpp"
#include "radar/exact/radar_query.hpp"
#include "radar/geometry/column_search.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/frame_along.hpp"
#include "radar/geometry/infinity.hpp"

namespace roomradar {

/// One query of CyberRadar in the frame of its motion, and the results of its exact tests so far. The frame
/// has its origin at the object's centre and its z axis along the direction of motion. Relative to the
/// object, the frame depends only on the direction. The object's height map M can thus be reused while the
/// direction in the object's frame is unchanged.
struct RadarSearch {
  const RadarQuery& query;
  const TriangleTree& tree;
  TurnedTree object;
  Eigen::Matrix3d R_frame_world;
  Eigen::Vector3d origin_world;
  /// True if the object is inflated (RadarQuery::margin_m > 0).
  bool is_thick;

  /// Least distance to contact found by an exact test, m.
  double best_m = kInfinity<double>;
  /// True if an exact test found an overlap. The search for contacts then ends.
  bool overlaps = false;
  /// The scene triangle that the object overlaps; set if `overlaps`.
  OverlappedTriangle overlapped;
  /// True if the object intersects a back-facing surface now.
  bool leaves_something = false;
  /// True if a contact with a back-facing surface was found ahead.
  bool met_a_back = false;
  /// True if back-facing surfaces are collected instead of counted as contacts.
  bool collects_backs = false;
  /// True if surfaces that may be behind M were left untested (see CyberRadar::kMostWorkBehind).
  bool is_cut_short = false;

  /// @param q       the query; must outlive the search
  /// @param u_mesh  unit direction of motion in the object's frame
  RadarSearch(const RadarQuery& q, const Eigen::Vector3d& u_mesh)
      : query(q), tree(*q.object.tree), is_thick(q.margin_m > 0.0) {
    object.tree = &tree;
    object.R_frame_mesh = frame_along(u_mesh);
    object.margin_m = q.margin_m;
    object.touching_m = touching_m(tree);
    R_frame_world = object.R_frame_mesh * q.object.T_world_mesh.linear().transpose();
    origin_world = q.object.T_world_mesh * (tree.origin() + tree.centre());
  }
  /// Returns the tolerance within which contacts count as equally near, m.
  [[nodiscard]] double equally_m() const { return object.touching_m; }
  /// Returns true if the object is closed and its triangle `o` faces against the motion.
  [[nodiscard]] bool is_rear(const FrameTriangle& o) const {
    return tree.is_closed() && o.normal.z() < -kEdgeOn;
  }
};

/// Sets the contact's point, normal and kind from a point in the search's frame. A normal that faces along
/// the motion is negated. A zero normal is replaced by the direction opposite to the motion.
inline void touch(const RadarSearch& search, const PatchPoint& at, Contact& contact) {
  const Eigen::Matrix3d R_world_frame = search.R_frame_world.transpose();
  contact.point_world = search.origin_world + R_world_frame * at.point;
  const Eigen::Vector3d facing = at.normal.isZero(0.0) ? -Eigen::Vector3d::UnitZ()
                                 : at.normal.z() > 0.0 ? Eigen::Vector3d(-at.normal)
                                                       : at.normal;
  contact.normal_world = R_world_frame * facing;
  contact.touched = at.kind;
}

}  // namespace roomradar
