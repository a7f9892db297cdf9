// building_corridor.hpp: a piece of a corridor, with what distinguishes it from the others.
#pragma once
#include <cstdint>

#include "app/sim/building/building_plan.hpp"
#include "app/sim/room/room.hpp"

namespace roomradar {

/// Max depth of anything that stands or hangs at a corridor's wall.
inline constexpr double kCorridorFurniture_m = 0.45;

/// Adds a piece of a corridor: its shell, a lamp, coloured frames around doorways, and pictures, boards,
/// cupboards, benches, plants and the like along its walls. Colours and furniture are drawn by the building's
/// seed, the floor and the piece; floor covering by floor.
/// @param look  seed of its materials, different for each piece
void add_corridor_piece(Room& room, const BuildingPlan& plan, int piece, int floor, std::uint32_t look);

}  // namespace roomradar
