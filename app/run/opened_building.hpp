// opened_building.hpp: the map of a building, opened for a run.
#pragma once
#include "app/cli/options/run_options.hpp"
#include "app/session/script/script.hpp"
#include "app/session/tiles/tile_window.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

struct OpenedBuilding {
  SavedMap map;  ///< keyframes and bounds; surface and octree are empty
  TileWindowConfig tiles;
};

/// Opens the building of options.map. With options.max_memory_mb, keyframes take at most a fifth of it.
/// Throws Error naming the file and the fault if a file is missing or damaged. Also throws Error if the run's
/// options or its script require the map of a room: for committed changes or recorded poses.
OpenedBuilding open_building(const RunOptions& options, const Script& script);

}  // namespace roomradar
