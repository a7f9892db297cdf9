// farm.cpp: a thread per process, which waits for it and takes the next job.
#include "app/farm/farm.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace roomradar {

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
