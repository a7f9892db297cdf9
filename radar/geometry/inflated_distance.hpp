// inflated_distance.hpp: distance along z until a triangle is within a margin of another triangle.
#pragma once
#include "radar/geometry/triangle_gap.hpp"

namespace roomradar {

/// Returns the least distance >= 0 that `object` can move along z until it is within margin_m of `scene`.
/// Returns 0 if `object` is within the margin now, and infinity if it never is. Once the result exceeds
/// limit_m, the search stops and returns a lower bound. The result never exceeds the true distance. The
/// result is less than the true distance only if the object grazes the margin and 20 steps do not converge.
///
/// The distance between two convex sets is a convex function of the distance moved. A plane perpendicular to
/// the shortest segment between the sets separates the sets. Each Newton step places this plane through the
/// scene's nearest point, and moves the object until its distance from the plane is the margin. Hence no step
/// passes the true solution.
double inflated_distance(const FrameTriangle& object, const FrameTriangle& scene, double margin_m,
                         double limit_m);

struct ShortestWay {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< start of the segment, on the object's triangle, m
  Eigen::Vector3d way = Eigen::Vector3d::Zero();   ///< vector from the start to the segment's end on the
                                                   ///< scene's triangle, m
};
/// Returns the shortest segment from the object's triangle, moved by contact_distance_m along z, to the
/// scene's triangle. Invalid if the triangles intersect.
ShortestWay shortest_way(const FrameTriangle& object, const FrameTriangle& scene, double contact_distance_m);

}  // namespace roomradar
