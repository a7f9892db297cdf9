// solid_inside.hpp: point-in-solid test for closed meshes.
#pragma once
#include <vector>

#include "radar/geometry/column_search.hpp"

namespace roomradar {

/// Crossing of a line along the motion with an object's surface.
struct Layer {
  double gap_m;  ///< height of the point above the crossing; negative if the crossing is ahead
  int way_out;   ///< 1 if the line leaves the solid there, -1 if it enters
};

/// Finds all crossings of the object's surface on the line through a point, ahead of it and up to limit_m
/// behind it.
/// @return false if the line runs too near an edge to count crossings
bool layers_at(const TurnedTree& object, const Eigen::Vector3d& point, double limit_m, ColumnScratch& scratch,
               std::vector<Layer>& layers);

/// Returns true if the point of `layers` is in the solid after the object has moved by contact_distance_m.
/// More exits than entries ahead of the point mean inside, so solids may overlap.
bool is_within(const std::vector<Layer>& layers, double contact_distance_m);

/// Returns true if a triangle that does not cross the object's surface is inside its solid, deeper than
/// touching_m. Counts the crossings ahead of it. False for an object that is not closed.
bool is_inside(const TurnedTree& object, const FrameTriangle& scene, ColumnScratch& scratch,
               std::vector<Layer>& layers);

/// Returns one of five points inside the triangle, at irregular positions.
Eigen::Vector3d inner_point(const FrameTriangle& triangle, int which);

}  // namespace roomradar
