// near_field.hpp: where does an object nearly touch, and for how long is it free while it moves and turns?
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radar/geometry/contact.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/geometry/tree_pairs.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// A place where the scene is near the object: the foot of a corner on a face, or where two edges pass.
struct NearPoint {
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();   ///< on the scene
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, from there to the object
  double gap_m = 0.0;                                      ///< >= 0; 0: they touch
  Touched kind = Touched::kNothing;
  std::uint32_t tree = 0;  ///< on which of the scene's trees
};

/// Some kinds of surfaces, a bit each.
using Kinds = std::uint32_t;
constexpr Kinds bit_of(Touched kind) { return Kinds{1} << static_cast<unsigned>(kind); }

struct FreeTime {
  double free_s = 0.0;  ///< up to this time no pair of triangles comes nearer than it may
  NearPoint limit;      ///< of the pair that allows no more, now; kNothing where all of the duration is free
};

/// Cyber Radar looks along one direction; near a contact, where an object turns over an edge, every direction
/// counts. This goes through the object's tree and the scene's trees (its depth images are left out) side by
/// side, and settles pairs of triangles in double. No GL. Not thread safe: one a thread; allocates nothing
/// once as much was held.
///
/// A surface that crosses the object has no side from which it is near: the radar's overlaps are what to ask
/// about it. Of a one-sided surface (is_one_sided()) nothing counts but what is near on its outside, and it
/// is never said to cross.
class NearField {
 public:
  /// Corners over faces and edges across edges within reach_m, at most kMostPoints of them: those that hold
  /// up most for up to four directions that normals have, the nearest first. A closed object is near what it
  /// faces only.
  /// @param left_out  kinds that are not looked at
  /// @param points    out
  /// @return kinds of surfaces that cross the object; of a tree that does, no point is given
  Kinds near(const TreeInstance& object, const RadarScene& scene, double reach_m, Kinds left_out,
             std::vector<NearPoint>& points);

  /// Until when a rigid motion is free of what does not cross the object now: each pair of triangles is
  /// kept apart by a plane (that of the one, of the other, or across their nearest points), and no corner
  /// moves towards it faster than its speed now plus what the turning can add. A pair may come as near as
  /// keep_m, one that is nearer than twice that by half of its distance.
  /// Source: Mirtich, PhD thesis, Berkeley 1996, section 2.3; Tang, Kim, Manocha, C2A: controlled
  /// conservative advancement, ICRA 2009.
  FreeTime free_time(const TreeInstance& object, const RigidMotion& motion, double duration_s, double keep_m,
                     const RadarScene& scene, Kinds left_out = 0);

  static constexpr std::size_t kMostPoints = 24;

 private:
  std::vector<PendingPair> pending_;
  std::vector<NearPoint> found_;
};

}  // namespace roomradar
