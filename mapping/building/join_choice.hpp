// join_choice.hpp: chooses the joins of a building that can all be right; finds the places that the refused
// ones mistake for each other.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "mapping/building/building_graph.hpp"
#include "mapping/building/submap_overlap.hpp"
#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// Returns, per join, true if the join is used. There are two kinds of conflicts between joins:
///   - a cycle of joins does not close, and drift does not explain the error;
///   - joins place two recordings at the same place, but their keyframes there show different things. For
///     example, a join mistakes a room for its twin on another floor, and the corridors outside differ.
/// Refuses the joins that break all conflicts at the least cost. The cost of a join grows with the length of
/// the path along which the recordings agree, and with the fraction of the surface that agrees. A conflict of
/// the second kind may also remain unresolved, since a room can change between two recordings. The cost of
/// leaving it grows with the number of consecutive keyframes that are not recognised.
/// @param test_overlap  compares two recordings that the joins place at the same place. Called only for pairs
///                      that no used join has compared there. Empty: recordings are not compared
/// Source: Sünderhauf and Protzel, Switchable constraints for robust pose graph SLAM, IROS 2012 (the
/// problem); hitting_set.hpp (the solution).
std::vector<bool> choose_joins(std::span<const GraphSubmap> submaps, std::span<const GraphJoin> joins,
                               const TestOverlap& test_overlap);

/// Returns pairs of places that look alike, in both directions: each refused join mistakes one place for the
/// other. Returns at most 12 pairs per join, at links spread evenly along the join. Ignores joins outside the
/// connected component `part`. Also ignores links that would move a place by less than 0.5 m and 0.5 rad,
/// since such joins are only inaccurate.
/// @param refused  joins that are not used, and joins with a status other than kJoined
std::vector<LookAlike> find_look_alikes(std::span<const PlacedSubmap> submaps, std::size_t part,
                                        std::span<const GraphJoin> refused);

}  // namespace roomradar
