// thick_travel.hpp: how far may a triangle go along z until it comes within a margin of another?
#pragma once
#include "radar/geometry/triangle_gap.hpp"

namespace roomradar {

/// Least travel >= 0 at which `object`, moved along z, is no farther than margin_m from `scene`: 0 if it is
/// so now, infinite if it never is, not looked at closely past limit_m. Never more than the truth, and less
/// only where the object would graze the margin (by an angle that 20 steps do not settle).
///
/// The distance between two convex sets is a convex function of the travel, and the plane that stands across
/// their nearest points stays between them: each Newton step goes to where that plane's distance is the
/// margin, which is never past the true place.
double thick_travel(const FrameTriangle& object, const FrameTriangle& scene, double margin_m, double limit_m);

struct ShortestWay {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< on the object's triangle
  Eigen::Vector3d way = Eigen::Vector3d::Zero();   ///< to the scene's
};
/// The shortest way from the object's triangle, moved by travel_m along z, to the scene's; where they cross,
/// not to be used.
ShortestWay shortest_way(const FrameTriangle& object, const FrameTriangle& scene, double travel_m);

}  // namespace roomradar
