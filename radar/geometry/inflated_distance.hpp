// inflated_distance.hpp: distance a triangle can move along z before it is within a margin of another.
#pragma once
#include "radar/geometry/triangle_gap.hpp"

namespace roomradar {

/// Returns the least travel >= 0 along z at which `object` is within margin_m of `scene`: 0 if it is so now,
/// infinite if it never is. Not refined past limit_m. Never more than the true distance, and less only if the
/// object grazes the margin at an angle that 20 steps do not resolve.
///
/// The distance between two convex sets is a convex function of the travel, and the plane across their
/// nearest points stays between them. Each Newton step goes to where the distance from that plane is the
/// margin, which is never past the true solution.
double inflated_distance(const FrameTriangle& object, const FrameTriangle& scene, double margin_m,
                         double limit_m);

struct ShortestWay {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< on the object's triangle
  Eigen::Vector3d way = Eigen::Vector3d::Zero();   ///< from there to the scene's triangle
};
/// Returns the shortest segment from the object's triangle, moved by contact_distance_m along z, to the
/// scene's. Invalid if they cross.
ShortestWay shortest_way(const FrameTriangle& object, const FrameTriangle& scene, double contact_distance_m);

}  // namespace roomradar
