// look_alikes.hpp: finds places of a building that look alike, from refused joins.
#pragma once
#include <span>
#include <vector>

#include "mapping/building/building_graph.hpp"
#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// Returns pairs of places that look alike, in both directions: each refused join mistakes one place for the
/// other. Returns at most 12 pairs per join, at links spread evenly along the join. Ignores joins outside the
/// connected component `part`. Also ignores links that would move a place by less than 0.5 m and 0.5 rad,
/// since such joins are only inaccurate.
/// @param refused  joins that are not used, and joins with a status other than kJoined
std::vector<LookAlike> find_look_alikes(std::span<const PlacedSubmap> submaps, std::size_t part,
                                        std::span<const GraphJoin> refused);

}  // namespace roomradar
