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
/// covering_walks() - 1 together visit all rooms. With several floors, each sixth walk is a stair walk, which
/// leads from one floor to the next. Of the other walks, each has one room in common with the next. From
/// number covering_walks() on, walks other than stair walks begin in a random room.
std::vector<int> rooms_of_walk(const BuildingPlan& plan, int walk);
/// Returns the number of walks that together visit all rooms: about 0.4 times the number of rooms, or about
/// 0.5 times if there are several floors.
int covering_walks(const BuildingPlan& plan);

/// Returns the points of a walk, one per kWalkStep_s. The walk leads round each room, facing the room's
/// middle, and along the corridors and stairs between the rooms, looking to the left and right. Max speed
/// 0.42 m/s, max turn 24 degrees/s. kRingWalk goes round one or several blocks of rooms, at least 200 m if
/// the building is large enough. With one corridor and several floors, kRingWalk goes up one stairwell and
/// down the other. With one corridor and one floor, it goes to both ends of the corridor and back.
std::vector<WalkPoint> plan_walk(const BuildingPlan& plan, int walk);

}  // namespace roomradar
