// building.hpp: a simulated building of furnished rooms, corridors and stairwells.
#pragma once
#include "app/sim/building/building_plan.hpp"
#include "app/sim/room/room.hpp"

namespace roomradar {

/// Makes a building. Its world frame has z up, the lowest floor at z = 0 and x along the corridors.
/// Room::parts are the rooms, in the order of their numbers, then floor by floor the pieces of corridors,
/// then the stairwells. The focus and the paths of moving objects are in room 0.
/// @param walk   number of the walk (camera trajectory) to store in Room::walk, see plan_walk()
/// @param crate  true: adds a crate on the ball's path, as in make_room()
Room make_building(const BuildingPlan& plan, int walk, bool crate = false);

}  // namespace roomradar
