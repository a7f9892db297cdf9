// holes_so_far.hpp: holes that a running scan has left.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "app/scan/live/exploration_grid.hpp"
#include "mapping/coverage/hole.hpp"

namespace roomradar {

/// A hole, and the number that it is shown with.
struct NumberedHole {
  int number = 0;  ///< 1-based
  Hole hole;
};

inline constexpr std::size_t kMostHolesShown = 9;

/// Finds space above the floor that no ray has crossed and that is inside the scan, as find_frontier() does
/// in the finished map, but in the grid's cells. A cell between two known cells counts as a gap between rays,
/// not as a hole. Leaves out holes below 0.15 m2. Returns the kMostHolesShown largest holes, largest first.
std::vector<Hole> holes_so_far(const ExplorationGrid& grid);

/// Numbers holes. A hole within 0.5 m of a hole that was shown before gets that hole's number; others get
/// free numbers.
std::vector<NumberedHole> numbered(const std::vector<Hole>& holes,
                                   std::span<const NumberedHole> shown_before = {});

}  // namespace roomradar
