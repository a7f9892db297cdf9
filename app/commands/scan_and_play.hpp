// scan_and_play.hpp: roomradar prescan and run, which alternate between scanning and playing in one window.
#pragma once
#include "app/cli/options/prescan_options.hpp"
#include "app/cli/options/run_options.hpp"

namespace roomradar {

/// Scans without a window, see scan(). With options.window, scans in a window, then plays in the map and
/// scans more of it as the user asks. Returns the exit status of the last part.
int run(const PrescanOptions& options);

/// Plays without a window, see play(). With options.window, plays in a window, then scans more of the map and
/// plays in it as the user asks. Returns the exit status of the last part.
int run(const RunOptions& options);

}  // namespace roomradar
