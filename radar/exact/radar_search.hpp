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

/// One query of CyberRadar in its frame, and what its exact tests have found so far. The frame has its origin
/// at the object's middle and z along the direction. It is fixed to the object, so M stays valid while the
/// direction is unchanged in the object's own frame.
struct RadarSearch {
  const RadarQuery& query;
  const TriangleTree& tree;
  TurnedTree object;
  Eigen::Matrix3d R_frame_world;
  Eigen::Vector3d origin_world;
  bool is_thick;

  double best_m = kInfinity<double>;  ///< least distance from an exact test
  bool overlaps = false;              ///< found by an exact test; nothing else matters then
  OverlappedTriangle overlapped;      ///< if overlaps
  bool leaves_something = false;      ///< a back-facing surface crosses the object now
  bool met_a_back = false;            ///< contact with a back-facing surface
  bool collects_backs = false;        ///< instead of treating them as contacts
  bool is_cut_short = false;          ///< not all scene that may be behind the front was tested

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
  /// Contacts at most this much farther than the nearest count as equally near.
  [[nodiscard]] double equally_m() const { return object.touching_m; }
  [[nodiscard]] bool is_rear(const FrameTriangle& o) const {
    return tree.is_closed() && o.normal.z() < -kEdgeOn;
  }
};

/// Sets the contact's point, normal and kind from a point in the search's frame. The normal faces against the
/// motion; a zero normal gives the direction against the motion.
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
