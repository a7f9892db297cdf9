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
  std::map<std::size_t, JobResult> results;  ///< of the jobs that ended in this run, by index
};

/// Returns why a job of the plan has no results, as a sentence; empty if it has. For a job that was skipped,
/// the sentence names the job that failed and the command that runs it.
std::string fault_of(const FarmPlan& plan, const FarmState& state, std::size_t job);

/// Called after each job, with its index, on one thread at a time.
using WatchFarm = std::function<void(const FarmState& state, std::size_t job)>;

/// Runs the jobs that are not present, each in a process of its own. If a job fails, only the jobs that need
/// it are skipped.
/// @param processes     number of jobs at a time; at least 1
/// @param program       file of the program that the jobs run
/// @param is_cancelled  once it returns true, running jobs are killed and no other begins
FarmState run_farm(const FarmPlan& plan, int processes, const std::filesystem::path& program,
                   const IsCancelled& is_cancelled, const WatchFarm& watch = {});

}  // namespace roomradar
