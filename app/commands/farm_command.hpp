// farm_command.hpp: roomradar farm: runs a list of commands as jobs.
#pragma once
#include "app/cli/options/farm_options.hpp"

namespace roomradar {

/// Executes the command. Returns the exit status: 1 if a job failed. Throws Error on failure.
int run(const FarmOptions& options);

}  // namespace roomradar
