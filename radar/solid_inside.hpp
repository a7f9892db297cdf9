// solid_inside.hpp: is a point in the solid that a closed mesh encloses?
#pragma once
#include <vector>

#include "radar/column_search.hpp"

namespace roomradar {

/// Gaps (height of the point above the surface) of all of the object's layers over a point, ahead of it
/// (negative) and up to limit_m behind it.
/// @return false if the line along the motion through the point runs too near an edge to count layers
bool layers_at(const TurnedTree& object, const Eigen::Vector3d& point, double limit_m,
               std::vector<PendingNode>& pending, std::vector<double>& gaps_m);

/// Whether a triangle that does not cross the object's surface lies in the solid that it encloses, deeper
/// than touching_m. By the parity of the layers ahead of it. False for an object that is not closed.
bool is_inside(const TurnedTree& object, const FrameTriangle& scene, std::vector<PendingNode>& pending,
               std::vector<double>& gaps_m);

/// A point of the triangle, one of several, none of them special.
Eigen::Vector3d inner_point(const FrameTriangle& triangle, int which);

}  // namespace roomradar
