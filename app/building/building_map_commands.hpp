// building_map_commands.hpp: roomradar map info|verify|export of a building.
#pragma once
#include "app/cli/options/map_options.hpp"

namespace roomradar {

// Each returns the exit status, and throws Error if a file cannot be read or written. The options' map must
// be a building's folder.

/// Prints recordings, tiles, extents, floors and areas.
int run_on_building(const MapInfoOptions& options);
/// Prints a sentence per fault. Returns 1 if there is one.
int run_on_building(const MapVerifyOptions& options);
/// Writes the octree or the surface of all tiles as one file, or a plan of each floor as .png.
int run_on_building(const MapExportOptions& options);

}  // namespace roomradar
