// proximity.hpp: closest features of an object and the scene.
#pragma once
#include <vector>

#include "radar/geometry/contact.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/motion/closest_point.hpp"
#include "radar/motion/free_time.hpp"

namespace roomradar {

/// Finds the vertex-face and edge-edge pairs of the object and the scene within reach_m. CyberRadar searches
/// along one direction. This function searches in all directions, since the points of an object that tips
/// over an edge move in many directions. Traverses both trees together and tests pairs of triangles exactly,
/// in double. Ignores the scene's depth images. Uses no OpenGL. Allocates nothing once queries of this size
/// have been run on the thread.
///
/// Groups the pairs of each tree by normal into up to four clusters, nearest cluster first. From each
/// cluster, returns the nearest pair and the outermost pairs in eight directions perpendicular to the normal.
/// For a closed object, only features outside it count. A tree that intersects the object gives no points:
/// use CyberRadar's overlaps. One-sided surfaces (is_one_sided()) are considered only from their front side
/// and are never reported as intersecting.
/// @param left_out  kinds of surfaces to ignore
/// @param trees     trees to ignore; motions have no effect
/// @param[out] points  the closest features, at most kMaxClosestPoints per tree
/// @return kinds of the surfaces that intersect the object
SurfaceKindMask near_features(const TreeInstance& object, const RadarScene& scene, double reach_m,
                              SurfaceKindMask left_out, const TreeStates& trees,
                              std::vector<ClosestPoint>& points);
inline SurfaceKindMask near_features(const TreeInstance& object, const RadarScene& scene, double reach_m,
                                     SurfaceKindMask left_out, std::vector<ClosestPoint>& points) {
  return near_features(object, scene, reach_m, left_out, {}, points);
}

}  // namespace roomradar
