// trade_command.hpp: roomradar trade: measures time and accuracy of quality settings.
#pragma once
#include "app/cli/options/trade_options.hpp"

namespace roomradar {

/// Measures the settings, prints the chosen presets and writes the requested files. Ctrl-C ends the
/// measurements; results then cover the measurements made so far. Returns the exit status: 1 if a job failed.
/// @throws Error if a scene is not suitable, nothing was measured, or a file cannot be written. Measurements
///         made before the error are written
int run(const TradeOptions& options);

}  // namespace roomradar
