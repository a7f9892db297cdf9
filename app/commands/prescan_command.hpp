// prescan_command.hpp: roomradar prescan: scans a room once and saves it as a map.
#pragma once
#include "app/cli/options/prescan_options.hpp"
#include "app/window/scan/scan_window.hpp"

namespace roomradar {

/// Scans the room without a window, saves the map, and prints its properties and largest holes. Returns the
/// exit status: 0, or 1 if the map was saved but could not be compared with the held-out frames.
/// @throws Error if the scan fails or is stopped. The message says how to continue the scan, if possible
int scan(const PrescanOptions& options);

/// Does the same as scan(), in a window. The result may contain the user's request to play in the map.
ScanWindowResult scan_in_window(const PrescanOptions& options);

}  // namespace roomradar
