// building_corridor.hpp: makes a piece of a corridor, with furniture that distinguishes it from other pieces.
#pragma once
#include <cstdint>

#include "app/sim/building/building_plan.hpp"
#include "app/sim/room/room.hpp"

namespace roomradar {

/// Max depth of the furniture along a corridor's walls.
inline constexpr double kCorridorFurniture_m = 0.45;

/// Adds a piece of a corridor: its shell, a lamp, coloured frames around doorways, and pictures, boards,
/// cupboards, benches and plants along its walls. Colours and furniture are chosen at random by the
/// building's seed, floor and piece, the floor covering by seed and floor.
/// @param look  seed of the materials, different for each piece
void add_corridor_piece(Room& room, const BuildingPlan& plan, int piece, int floor, std::uint32_t look);

}  // namespace roomradar
