// hitting_set.hpp: the cheapest elements that break every conflict.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace roomradar {

/// Elements that cannot all be right.
using Conflict = std::vector<std::size_t>;

/// Returns the elements, in order, that together have at least one of each conflict and the least sum of
/// costs. Exact (branch and bound) up to a fixed number of steps, after which the best set found so far is
/// returned. Deterministic. Conflicts must not be empty. Source: Reiter, A theory of diagnosis from first
/// principles, Artificial Intelligence 1987.
/// @param costs  by element, each above 0
std::vector<std::size_t> cheapest_hitting_set(std::span<const Conflict> conflicts,
                                              std::span<const double> costs);

}  // namespace roomradar
