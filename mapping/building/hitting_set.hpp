// hitting_set.hpp: minimum-cost hitting set: the cheapest elements that break every conflict.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace roomradar {

/// Indices of elements that cannot all be right.
using Conflict = std::vector<std::size_t>;

/// Returns the set of elements with the least sum of costs that contains an element of each conflict. The
/// elements are in ascending order. Exact, by branch and bound. After a fixed number of steps, returns the
/// best set found so far. Deterministic. Conflicts must not be empty. Source: Reiter, A theory of diagnosis
/// from first principles, Artificial Intelligence 1987.
/// @param costs  per element, each above 0
std::vector<std::size_t> cheapest_hitting_set(std::span<const Conflict> conflicts,
                                              std::span<const double> costs);

}  // namespace roomradar
