// grid_command.hpp: roomradar fallthrough with a source: fall-through test in a recorded room.
#pragma once
#include "app/cli/options/fallthrough_options.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

/// Drops a ball over each cell of a grid in the map, with the surfaces of the source's first frame. Prints
/// the table, writes picture and report. Throws Error if the frame cannot be localised.
int run_grid(const FallthroughOptions& options);

/// Returns true if the frames of both maps have recorded poses in the same world: both maps are of one
/// recording, possibly with different --frames.
bool share_recorded_world(const MapInfo& a, const MapInfo& b);

}  // namespace roomradar
