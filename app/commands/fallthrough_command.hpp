// fallthrough_command.hpp: roomradar fallthrough: drops objects onto hidden surfaces, with each surface
// policy.
#pragma once
#include "app/cli/options/fallthrough_options.hpp"

namespace roomradar {

/// Runs the scenarios in simulated rooms, or run_grid() if a source is given. Prints a table and writes the
/// requested files. Returns the exit status: 1 if a job of options.jobs failed, else 0.
/// @throws Error if a room cannot be scanned or a file cannot be written. Results obtained before the error
///         are written
int run(const FallthroughOptions& options);

}  // namespace roomradar
