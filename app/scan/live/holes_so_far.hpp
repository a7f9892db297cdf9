// holes_so_far.hpp: finds the holes in the surface scanned so far.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "app/scan/live/exploration_grid.hpp"
#include "mapping/coverage/holes.hpp"

namespace roomradar {

/// A hole, and its number in the display.
struct NumberedHole {
  int number = 0;  ///< 1-based
  Hole hole;
};

inline constexpr std::size_t kMostHolesShown = 9;

/// Finds unobserved space inside the scan and above the floor. The method is that of find_frontier() for a
/// finished map, applied to the grid's cells. An unknown cell between two known cells counts as a gap between
/// rays, not as a hole. Ignores holes below 0.15 m2. Returns the kMostHolesShown largest holes, largest
/// first.
std::vector<Hole> holes_so_far(const ExplorationGrid& grid);

/// Numbers holes. A hole within 0.5 m of a hole in `shown_before` keeps its number. Other holes are assigned
/// unused numbers.
std::vector<NumberedHole> numbered(const std::vector<Hole>& holes,
                                   std::span<const NumberedHole> shown_before = {});

}  // namespace roomradar
