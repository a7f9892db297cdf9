// farm.hpp: runs the jobs of a plan on this machine's processors, each in its own process.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "app/farm/farm_plan.hpp"

namespace roomradar {

enum class JobState {
  kNotPlanned,
  kWaiting,  ///< waits for a job that it needs, or for its turn
  kRunning,
  kPresent,  ///< had results before this run
  kDone,
  kFailed,   ///< failed in this run, or before it and is not run again
  kSkipped,  ///< a job that it needs failed
};

/// Assigns the jobs of a plan, the most expensive first, and each after the jobs that it needs.
class Schedule {
 public:
  explicit Schedule(const FarmPlan& plan);

  /// Returns the next job, and marks it as running. Returns nullopt if no job can begin now.
  std::optional<std::size_t> next();
  /// Records the outcome of a running job. If it failed, the jobs that need it are skipped.
  void finish(std::size_t job, bool is_done);

  /// Returns true if no job is waiting or running.
  [[nodiscard]] bool is_over() const { return left_ == 0; }
  [[nodiscard]] JobState state(std::size_t job) const { return states_[job]; }
  [[nodiscard]] std::size_t count(JobState state) const;

 private:
  std::vector<JobState> states_;
  std::vector<double> costs_;
  std::vector<std::size_t> open_needs_;  ///< per job: number of needed jobs that are not done
  std::vector<std::vector<std::size_t>> needed_by_;
  std::priority_queue<std::pair<double, std::ptrdiff_t>> ready_;  ///< cost, and the negative index
  std::size_t left_ = 0;

  void make_ready(std::size_t job);
  void skip_those_that_need(std::size_t job);
};

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
/// @param program  path of the executable that the job runs
JobResult run_job(const FarmPlan& plan, std::size_t job, const std::filesystem::path& program,
                  const IsCancelled& is_cancelled);

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
/// @param program       path of the executable that the jobs run
/// @param is_cancelled  once it returns true, running jobs are killed and no more jobs begin
FarmState run_farm(const FarmPlan& plan, int processes, const std::filesystem::path& program,
                   const IsCancelled& is_cancelled, const WatchFarm& watch = {});

}  // namespace roomradar
