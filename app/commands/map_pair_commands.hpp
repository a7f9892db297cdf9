// map_pair_commands.hpp: roomradar map merge|diff: merges or compares two maps of one room.
#pragma once
#include "app/cli/options/map_options.hpp"

namespace roomradar {

// Both return the exit status 0, and throw Error if a file cannot be read or written, or if the maps cannot
// be registered reliably.

/// Adds map b to map a and saves the result as a new map.
int run(const MapMergeOptions& options);
/// Prints the objects that appeared or vanished between map a and map b.
int run(const MapDiffOptions& options);

}  // namespace roomradar
