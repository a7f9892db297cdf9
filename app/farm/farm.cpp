// farm.cpp: a thread per process, which waits for it and takes the next job.
#include "app/farm/farm.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace roomradar {
namespace {

/// Returns the failed job because of which a job was skipped.
std::size_t failed_need(const FarmPlan& plan, const Schedule& schedule, std::size_t job) {
  while (schedule.state(job) == JobState::kSkipped) {
    const std::vector<std::size_t>& needs = plan.manifest.jobs[job].needs;
    job = *std::find_if(needs.begin(), needs.end(), [&](std::size_t need) {
      return schedule.state(need) == JobState::kFailed || schedule.state(need) == JobState::kSkipped;
    });
  }
  return job;
}

}  // namespace

std::string fault_of(const FarmPlan& plan, const FarmState& state, std::size_t job) {
  switch (state.schedule.state(job)) {
    case JobState::kFailed:
      break;
    case JobState::kSkipped: {
      const std::string& need = plan.manifest.jobs[failed_need(plan, state.schedule, job)].name;
      return "was not run, because the job " + need +
             ", which it needs, failed; to run that again: " + "roomradar farm " +
             plan.manifest.path.string() + " --out " + plan.out.string() + " --job " + need;
    }
    case JobState::kWaiting:
    case JobState::kRunning:
      return "was not run";
    default:
      return {};
  }
  const auto found = state.results.find(job);
  return (found == state.results.end() ? plan.jobs[job].earlier_fault : found->second.fault) + "; see " +
         (plan.out / (plan.manifest.jobs[job].name + ".log")).string();
}

FarmState run_farm(const FarmPlan& plan, int processes, const std::filesystem::path& program,
                   const IsCancelled& is_cancelled, const WatchFarm& watch) {
  FarmState state{Schedule(plan), {}};
  std::mutex mutex;  // guards `state`
  std::condition_variable changed;
  const auto work = [&] {
    for (std::unique_lock lock(mutex);;) {
      if (state.schedule.is_over() || is_cancelled()) return;
      const std::optional<std::size_t> job = state.schedule.next();
      if (!job) {
        changed.wait(lock);  // a running job may make others ready
        continue;
      }
      lock.unlock();
      JobResult result = run_job(plan, *job, program, is_cancelled);
      lock.lock();
      state.schedule.finish(*job, result.is_done);
      state.results[*job] = std::move(result);
      if (watch) watch(state, *job);
      changed.notify_all();
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < processes; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  return state;
}

}  // namespace roomradar
