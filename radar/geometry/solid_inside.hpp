// solid_inside.hpp: point-in-solid test for closed meshes.
#pragma once
#include <vector>

#include "radar/geometry/column_search.hpp"

namespace roomradar {

/// Crossing of an object's surface with a line that is parallel to the motion.
struct Layer {
  /// Distance of the query point ahead of the crossing, m; negative if the crossing is ahead of the point.
  double gap_m;
  /// 1 if the line, followed along the motion, leaves the solid at the crossing; -1 if it enters the solid.
  int way_out;
};

/// Finds the crossings of the object's surface with the line through a point along the motion. Finds all
/// crossings ahead of the point, and those up to limit_m behind it.
/// @return false if the line passes so close to an edge that rounding decides which triangles it crosses
bool layers_at(const TurnedTree& object, const Eigen::Vector3d& point, double limit_m, ColumnScratch& scratch,
               std::vector<Layer>& layers);

/// Returns true if the point for which layers_at() found `layers` is inside the solid after the object has
/// moved by contact_distance_m. The point is inside if there are more exits than entries ahead of it. This
/// rule holds even if components of the mesh overlap each other.
bool is_within(const std::vector<Layer>& layers, double contact_distance_m);

/// Returns true if a scene triangle is inside the object's solid, more than touching_m deep. One point of the
/// triangle decides, so the triangle must not intersect the object's surface. Returns false if the object is
/// not closed or if none of five points is decisive.
bool is_inside(const TurnedTree& object, const FrameTriangle& scene, ColumnScratch& scratch,
               std::vector<Layer>& layers);

/// Returns a point inside the triangle, at one of five irregular barycentric positions, selected by `which`.
Eigen::Vector3d inner_point(const FrameTriangle& triangle, int which);

}  // namespace roomradar
