// room_parts.hpp: finds the part of a building that contains a point, and the parts that are visible from it.
#pragma once
#include <vector>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Returns the index of the part whose bounds contain the point; -1 if there is none, as in a single room.
int part_at(const Room& room, const Eigen::Vector3d& p_world);

/// Returns the index of the part that the solid belongs to; -1 in a single room.
int part_of_solid(const Room& room, std::size_t solid);

/// Returns the indices, ascending, of the parts that may be visible from points within margin_m of eye_world.
/// Follows lines of sight through the openings: each opening restricts the ranges of azimuth and slope for
/// the openings behind it. Returns all parts if no part contains the point.
/// Source: Luebke, Georges, Portals and mirrors, Symposium on Interactive 3D Graphics 1995.
std::vector<int> visible_parts(const Room& room, const Eigen::Vector3d& eye_world, double margin_m = 0.2);

}  // namespace roomradar
