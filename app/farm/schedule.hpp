// schedule.hpp: chooses the next job of a plan.
#pragma once
#include <cstddef>
#include <optional>
#include <queue>
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

}  // namespace roomradar
