// farm_command.hpp: jobs of roomradar farm, and of commands that split their work into jobs.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/cli/options/measuring_options.hpp"
#include "app/farm/farm.hpp"

namespace roomradar {

/// Returns the plan of the jobs that the options name. Throws Error as plan_farm() does.
FarmPlan plan_of(const FarmOptions& options);

/// Function that runs the jobs of a plan, and calls the given function after each.
using RunJobs = std::function<FarmState(const WatchFarm&)>;
/// Runs a plan with progress on stderr. Prints the final state of the jobs and writes the report.
FarmState run_planned(const FarmOptions& options, const FarmPlan& plan, const RunJobs& run_jobs);
/// Returns 1 if a job failed or was skipped, otherwise 0.
int exit_status(const FarmState& state);

/// By name of job: why the job has no results.
using JobFaults = std::map<std::string, std::string>;
/// Runs the jobs into which a command splits its work, on this machine. Skips jobs that already have results.
/// @param folder     folder for the results, and for the manifest (jobs.txt); created if missing
/// @param manifest   text; see read_manifest()
/// @param program    name of the program that does the jobs, such as roomradar-trade
/// @param jobs       names of the jobs to run, with the jobs that they need; empty: all
/// @param processes  number of concurrent jobs; 0: one per processor
/// @throws Error if the folder cannot be written or Ctrl-C is pressed
JobFaults run_split(const std::string& folder, const std::string& manifest, const std::string& program,
                    const std::vector<std::string>& jobs, int processes);

}  // namespace roomradar
