// grid_command.hpp: the fall-through test in a recorded room.
#pragma once
#include "app/commands/commands.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

/// Drops a ball over each cell of a grid in the map, with the surfaces of the source's first frame; prints
/// the table, writes plan and report. Throws Error if the frame cannot be located.
int run_grid(const FallthroughCommand& command);

/// Whether the frames that both were made of came with poses in one world: those of one recording, maybe of
/// different --frames.
bool share_recorded_world(const MapInfo& a, const MapInfo& b);

}  // namespace roomradar
