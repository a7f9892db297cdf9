// join_choice.hpp: chooses the joins of a building that can all be right.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "mapping/building/building_graph.hpp"
#include "mapping/building/submap_overlap.hpp"

namespace roomradar {

/// Returns for each join whether it is used. Joins contradict each other in two ways:
///   - a cycle of joins that does not close, by more than drift explains;
///   - joins that put two recordings at the same place, where their keyframes then show different things.
///     This is how a room with a twin on another floor is found out: its corridor is another one.
/// Refuses the joins that break all these conflicts at the least cost. A join costs more, the longer the way
/// is along which the recordings agree, and the more of the surface agrees. A conflict of the second kind may
/// also be left, at the cost of the keyframes that it concerns: a room can change between two recordings.
/// @param test_overlap  how recordings are compared where the joins put them at the same place; empty: they
///                      are not. It is called only for those that no used join has compared there
/// Source: Sünderhauf and Protzel, Switchable constraints for robust pose graph SLAM, IROS 2012 (the
/// problem); hitting_set.hpp (the solution).
std::vector<bool> choose_joins(std::span<const GraphSubmap> submaps, std::span<const GraphJoin> joins,
                               const TestOverlap& test_overlap);

}  // namespace roomradar
