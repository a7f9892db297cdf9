// farm_command.hpp: roomradar farm: runs a list of commands as jobs.
#pragma once
#include <functional>

#include "app/cli/options/farm_options.hpp"
#include "app/farm/farm.hpp"

namespace roomradar {

/// Executes the command. Returns the exit status: 1 if a job failed. Throws Error on failure.
int run(const FarmOptions& options);

/// Returns the plan of the jobs that the options name. Throws Error as plan_farm() does.
FarmPlan plan_of(const FarmOptions& options);

/// Function that runs the jobs of a plan, and calls the given function after each.
using RunJobs = std::function<FarmState(const WatchFarm&)>;
/// Runs a plan with progress on stderr, prints and reports how it ended. Returns the exit status.
int run_planned(const FarmOptions& options, const FarmPlan& plan, const RunJobs& run_jobs);

}  // namespace roomradar
