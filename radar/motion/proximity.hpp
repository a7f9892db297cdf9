// proximity.hpp: closest features of an object and the scene, and contact-free time of a rigid motion.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radar/geometry/contact.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/geometry/tree_pairs.hpp"
#include "radar/motion/closest_point.hpp"
#include "radar/motion/free_time.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// Proximity queries between an object and the scene's trees; the scene's depth images are ignored.
/// CyberRadar looks along one direction; near a contact, where an object turns over an edge, every direction
/// matters. Traverses both trees together and tests pairs of triangles exactly, in double. No GL. Not thread
/// safe: use one per thread. Allocates nothing after queries as large.
///
/// A surface that crosses the object has no near side; use CyberRadar's overlaps for it. A one-sided surface
/// (is_one_sided()) counts only on its outside and is never reported as crossing.
class ProximityQuery {
 public:
  /// Finds corners over faces and edges across edges within reach_m, at most kMaxPoints. For up to four
  /// normal directions, returns the points that support the object most, nearest first. For a closed object
  /// only features outside it count.
  /// @param left_out  kinds to ignore
  /// @param points    out
  /// @return kinds of surfaces that cross the object; a tree that crosses it gives no points
  SurfaceKindMask near(const TreeInstance& object, const RadarScene& scene, double reach_m,
                       SurfaceKindMask left_out, std::vector<ClosestPoint>& points);

  /// See free_time() in free_time.hpp.
  FreeTime free_time(const TreeInstance& object, const RigidMotion& motion, double duration_s, double keep_m,
                     const RadarScene& scene, SurfaceKindMask left_out = 0);

  static constexpr std::size_t kMaxPoints = kMaxClosestPoints;

 private:
  std::vector<PendingPair> pending_;
  std::vector<ClosestPoint> found_;
};

}  // namespace roomradar
