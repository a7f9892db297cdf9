// trade_command.hpp: roomradar trade: measures time against accuracy.
#pragma once
#include "app/cli/options/trade_options.hpp"

namespace roomradar {

/// Measures the settings, prints the chosen presets and writes the requested files. Ctrl-C ends the
/// measurements; the result then covers those made so far. Returns the exit status 0.
/// @throws Error if a scene is not suitable, if nothing was measured, or if a file cannot be written; earlier
///         measurements are still written
int run(const TradeOptions& options);

}  // namespace roomradar
