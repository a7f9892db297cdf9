// job_process.hpp: runs one job of a farm in its own process.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "app/farm/farm_plan.hpp"

namespace roomradar {

struct JobResult {
  bool is_done = false;
  std::string fault;  ///< reason of a failure, as a sentence
  double wall_s = 0.0;
  double cpu_s = 0.0;    ///< CPU time of the process
  double peak_mb = 0.0;  ///< peak memory, 10^6 bytes
};

/// Returns true once the farm should end. Called on several threads.
using IsCancelled = std::function<bool()>;

/// Runs a job in its folder, and waits for its end. The job's output goes to NAME.log. The process is killed
/// when the calling thread ends or `is_cancelled` returns true. Does not throw: a job that cannot be run
/// counts as failed.
/// @param program  path of the program, such as /proc/self/exe
JobResult run_job(const FarmPlan& plan, std::size_t job, const std::filesystem::path& program,
                  const IsCancelled& is_cancelled);

}  // namespace roomradar
