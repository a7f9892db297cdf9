// grid_command.hpp: the fall-through test in a recorded room.
#pragma once
#include "app/commands.hpp"

namespace roomradar {

/// Drops a ball over each cell of a grid in the map, with the surfaces of the source's first frame; prints
/// the table, writes plan and report. Throws Error if the frame cannot be located.
int run_grid(const FallthroughCommand& command);

}  // namespace roomradar
