// prescan_command.hpp: roomradar prescan: scans a room once and saves it as a map.
#pragma once
#include "app/cli/options/prescan_options.hpp"

namespace roomradar {

/// Scans the room, saves the map, and prints its properties and largest holes. Returns the exit status: 0, or
/// 1 if the map was saved but could not be compared with the held-out frames.
/// @throws Error if the scan fails or is stopped. The message says how to continue the scan, if possible
int run(const PrescanOptions& options);

}  // namespace roomradar
