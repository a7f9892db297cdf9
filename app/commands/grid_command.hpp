// grid_command.hpp: fall-through test in a recorded room (roomradar fallthrough with a source).
#pragma once
#include "app/cli/options/measuring_options.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

/// Drops a ball in each cell of a grid over the map, onto the surfaces of the source's first frame. Prints
/// the table, and writes picture and report. Returns the exit status 0. Throws Error if there is no readable
/// frame, or it cannot be localised.
int run_grid(const FallthroughOptions& options);

/// Returns true if both maps were made from recorded poses of the same recording, possibly with different
/// --frames. Both maps then have the same world frame.
bool share_recorded_world(const MapInfo& a, const MapInfo& b);

}  // namespace roomradar
