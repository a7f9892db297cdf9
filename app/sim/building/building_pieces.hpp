// building_pieces.hpp: corridors of a building in pieces, with openings to rooms and stairwells.
#pragma once
#include "app/sim/building/building_plan.hpp"

namespace roomradar {

/// Adds the pieces of the corridors, and the stairwells if there is more than one floor, to a plan that has
/// its rooms, BuildingPlan::corridor_y_m and BuildingPlan::length_m. Pieces are 4 to 8 m long, with their
/// boundaries between doors.
void add_corridors(BuildingPlan& plan);

}  // namespace roomradar
