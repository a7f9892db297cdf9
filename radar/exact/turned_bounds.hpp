// turned_bounds.hpp: bounding box of a triangle tree in a rotated frame.
#pragma once
#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "radar/geometry/column_search.hpp"

namespace roomradar {

/// Max relative rounding error of a linear function of a point in float, with a safety factor.
inline constexpr float kHeightRounding = 16.0F * std::numeric_limits<float>::epsilon();

/// Returns the object's bounding box in the rotated frame, enlarged by rounding error and margin. Each side
/// is at most tolerance_m too far out. Runs one search of the tree per side of the box.
/// @param pending  scratch memory
Eigen::AlignedBox3d turned_bounds(const TurnedTree& object, double tolerance_m,
                                  std::vector<PendingNode>& pending);

}  // namespace roomradar
