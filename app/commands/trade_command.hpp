// trade_command.hpp: roomradar trade: measures time against accuracy.
#pragma once
#include "app/cli/options/trade_options.hpp"

namespace roomradar {

/// Measures the settings, prints the chosen presets and writes the requested files. Ctrl-C ends the
/// measurements; those so far are the result. Returns the exit status 0.
/// @throws Error if a scene is not suitable, if nothing was measured, or if a file cannot be written; earlier
/// measurements are written all the same
int run(const TradeOptions& options);

}  // namespace roomradar
