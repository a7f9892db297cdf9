// solid_inside.hpp: is a point in the solid that a closed mesh encloses?
#pragma once
#include <vector>

#include "radar/geometry/column_search.hpp"

namespace roomradar {

/// Where a line along the motion goes through an object's surface.
struct Layer {
  double gap_m;  ///< height of the point above the layer: negative where the layer is ahead of it
  int way_out;   ///< 1 where the line leaves the solid there, -1 where it enters
};

/// All of the object's layers over a point, ahead of it and up to limit_m behind it.
/// @return false if the line along the motion through the point runs too near an edge to count layers
bool layers_at(const TurnedTree& object, const Eigen::Vector3d& point, double limit_m, ColumnScratch& scratch,
               std::vector<Layer>& layers);

/// Whether a point travel_m back along the motion from the one whose layers these are is in a solid: more
/// ways out than in are ahead of it, so that solids may overlap.
bool is_within(const std::vector<Layer>& layers, double travel_m);

/// Whether a triangle that does not cross the object's surface lies in the solid that it encloses, deeper
/// than touching_m. By the layers ahead of it. False for an object that is not closed.
bool is_inside(const TurnedTree& object, const FrameTriangle& scene, ColumnScratch& scratch,
               std::vector<Layer>& layers);

/// A point of the triangle, one of several, none of them special.
Eigen::Vector3d inner_point(const FrameTriangle& triangle, int which);

}  // namespace roomradar
