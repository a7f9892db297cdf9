// building_walk.hpp: walks (camera trajectories) through a building. Each walk gives one recording.
#pragma once
#include <vector>

#include "app/sim/building/building_plan.hpp"
#include "app/sim/room/room.hpp"

namespace roomradar {

/// Number of the walk around the corridors, back to its start. Other walks have the numbers 0 to kLastWalk.
inline constexpr int kRingWalk = -1;
inline constexpr int kLastWalk = 9999;
/// Time between two points of a walk, and mean height of the camera above the floor.
inline constexpr double kWalkStep_s = 1.0, kEyeHeight_m = 1.45;

/// Returns the numbers of the rooms that a walk visits, in the walk's order; empty for kRingWalk. Walks 0 to
/// covering_walks() - 1 together visit all rooms. A stair walk leads from one floor to the next. Each other
/// walk visits a room that the next walk other than a stair walk visits, too. Later walks begin in any room.
std::vector<int> rooms_of_walk(const BuildingPlan& plan, int walk);
/// Returns the number of walks that together visit all rooms: about 0.4 times the number of rooms, or half of
/// it if there are several floors.
int covering_walks(const BuildingPlan& plan);

/// Returns the points of a walk, one per kWalkStep_s: round each room, facing its middle, and along the
/// corridors and stairs between them, looking to the left and right. Max speed 0.42 m/s, max turn 24
/// degrees/s. kRingWalk goes round one or several blocks of rooms, at least 200 m if the building is large
/// enough. In a building with one corridor, it goes up one stairwell and down the other one. On a single
/// floor, it goes to both ends of the corridor and back.
std::vector<WalkPoint> plan_walk(const BuildingPlan& plan, int walk);

}  // namespace roomradar
