// map_command.hpp: roomradar map info|verify|export: describes, checks and exports a saved map.
#pragma once
#include "app/cli/options/map_options.hpp"

namespace roomradar {

// Each returns the exit status, and throws Error if a file cannot be read or written.

/// Prints the map's properties.
int run(const MapInfoOptions& options);
/// Compares the map's files with their checksums. Returns 1 if a file differs.
int run(const MapVerifyOptions& options);
/// Writes the octree, the mesh or the frontier of unknown space to a file.
int run(const MapExportOptions& options);

}  // namespace roomradar
