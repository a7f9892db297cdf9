// farm.hpp: runs the jobs of a plan on this machine's processors.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "app/farm/job_process.hpp"
#include "app/farm/schedule.hpp"

namespace roomradar {

/// State of a farm during or after its run.
struct FarmState {
  Schedule schedule;
  std::map<std::size_t, JobResult> results;  ///< results of jobs that ended in this run, by index
};

/// Returns the reason why a job has no results, as a sentence; empty if it has results. For a skipped job,
/// the sentence names the failed job and the command that runs it.
std::string fault_of(const FarmPlan& plan, const FarmState& state, std::size_t job);

/// Called with the index of each job after its end, on one thread at a time.
using WatchFarm = std::function<void(const FarmState& state, std::size_t job)>;

/// Runs the jobs without results, each in its own process. If a job fails, only the jobs that need it are
/// skipped.
/// @param processes     max number of jobs at a time, >= 1
/// @param program       file of the program that the jobs run
/// @param is_cancelled  once it returns true, running jobs are killed and no more jobs begin
FarmState run_farm(const FarmPlan& plan, int processes, const std::filesystem::path& program,
                   const IsCancelled& is_cancelled, const WatchFarm& watch = {});

}  // namespace roomradar
