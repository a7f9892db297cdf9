// look_alikes.hpp: places of a building that look alike, from joins that were refused.
#pragma once
#include <span>
#include <vector>

#include "mapping/building/building_graph.hpp"
#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// Returns the places that refused joins take for one, in both directions: for each join up to 12, at
/// keyframes spread along it. Leaves out joins of submaps in another part than `part`, and those that would
/// move a place by less than 0.5 m and 0.5 rad: they are of one place, and only inaccurate.
/// @param refused  joins that are not used, and those with another status than kJoined
std::vector<LookAlike> find_look_alikes(std::span<const PlacedSubmap> submaps, std::size_t part,
                                        std::span<const GraphJoin> refused);

}  // namespace roomradar
