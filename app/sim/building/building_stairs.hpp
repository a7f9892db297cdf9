// building_stairs.hpp: a stairwell with steps, landings and banisters.
#pragma once
#include "app/sim/building/building_plan.hpp"
#include "app/sim/room/room.hpp"

namespace roomradar {

/// Adds a stairwell over all floors, with its lamps and pictures.
/// @param look  seed of its materials
void add_stairwell(Room& room, const BuildingPlan& plan, const PlannedStairs& stairs, std::uint32_t look);

/// Height of the stairwell's ceiling above the world's origin.
double stairwell_top_m(const BuildingPlan& plan);

}  // namespace roomradar
