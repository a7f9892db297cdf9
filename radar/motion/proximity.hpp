// proximity.hpp: closest features of an object and the scene, and the contact-free duration of a motion.
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

/// Proximity queries between an object and the scene's triangle trees. CyberRadar searches along one
/// direction, this class in all directions: an object that tips over an edge moves in many. Traverses both
/// trees together and tests pairs of triangles exactly, in double. Ignores the scene's depth images. Uses no
/// OpenGL. Not thread safe: use one instance per thread. Allocates nothing once queries of this size have
/// been run.
///
/// Surfaces that intersect the object have no closest features. Use CyberRadar's overlaps for them. One-sided
/// surfaces (is_one_sided()) are considered only from their front side and are never reported as
/// intersecting.
class ProximityQuery {
 public:
  /// Finds the vertex-face and edge-edge pairs within reach_m. Groups the pairs of each tree by normal into
  /// up to four clusters, nearest cluster first. From each cluster, returns the nearest pair and the
  /// outermost pairs in eight directions perpendicular to the normal. For a closed object, only features
  /// outside it count. A tree that intersects the object gives no points.
  /// @param left_out  kinds of surfaces to ignore
  /// @param trees     trees to ignore; motions have no effect
  /// @param[out] points  the closest features, at most kMaxPointsPerTree per tree
  /// @return kinds of the surfaces that intersect the object
  SurfaceKindMask near(const TreeInstance& object, const RadarScene& scene, double reach_m,
                       SurfaceKindMask left_out, const TreeStates& trees, std::vector<ClosestPoint>& points);
  SurfaceKindMask near(const TreeInstance& object, const RadarScene& scene, double reach_m,
                       SurfaceKindMask left_out, std::vector<ClosestPoint>& points) {
    return near(object, scene, reach_m, left_out, {}, points);
  }

  /// Computes the contact-free duration of a motion; see free_time.hpp.
  FreeTime free_time(const TreeInstance& object, const RigidMotion& motion, double duration_s, double keep_m,
                     const RadarScene& scene, SurfaceKindMask left_out = 0, const TreeStates& trees = {});

  static constexpr std::size_t kMaxPointsPerTree = kMaxClosestPoints;

 private:
  std::vector<PendingPair> pending_;
  std::vector<ClosestPoint> found_, kept_;
};

}  // namespace roomradar
