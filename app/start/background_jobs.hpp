// background_jobs.hpp: runs jobs on a worker thread and delivers the results on the caller's thread.
#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace roomradar {

/// Runs jobs sequentially on a worker thread, in the order in which they were added. All calls must come from
/// one thread. deliver() passes the results to their callbacks on that thread.
class BackgroundJobs {
 public:
  /// @param on_result  called on the worker thread when a result is ready for deliver()
  explicit BackgroundJobs(std::function<void()> on_result);
  /// Waits for the running job; discards queued jobs.
  ~BackgroundJobs();
  BackgroundJobs(const BackgroundJobs&) = delete;
  BackgroundJobs& operator=(const BackgroundJobs&) = delete;

  /// Adds a job. The worker thread calls `work`. deliver() then calls done(result of work), or
  /// failed(message) if `work` has thrown.
  template <typename Work, typename Done>
  void add(Work work, Done done, std::function<void(const std::string&)> failed) {
    push([work = std::move(work), done = std::move(done), failed = std::move(failed)]() -> Result {
      try {
        return [done, result = work()]() mutable { done(std::move(result)); };
      } catch (const std::exception& error) {
        return [failed, what = std::string(error.what())] { failed(what); };
      }
    });
  }

  /// Passes the finished jobs' results to their callbacks.
  void deliver();
  /// Returns true if no job waits or runs, and all results were delivered.
  [[nodiscard]] bool is_idle() const { return pending_ == 0; }

 private:
  using Result = std::function<void()>;
  using Job = std::function<Result()>;

  std::function<void()> on_result_;
  int pending_ = 0;  ///< number of jobs whose result has not been delivered
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  std::deque<Result> results_;
  bool ends_ = false;
  std::thread thread_;

  void push(Job job);
  void run_jobs();
};

}  // namespace roomradar
