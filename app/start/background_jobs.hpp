// background_jobs.hpp: runs work on another thread and delivers the results on the thread of a window.
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

/// Runs jobs one after the other, in the order in which they were added. All calls must come from one thread.
/// deliver() passes the results on that thread.
class BackgroundJobs {
 public:
  /// @param on_result  called on the jobs' thread when a result waits for deliver()
  explicit BackgroundJobs(std::function<void()> on_result);
  /// Waits for the running job; drops waiting jobs.
  ~BackgroundJobs();
  BackgroundJobs(const BackgroundJobs&) = delete;
  BackgroundJobs& operator=(const BackgroundJobs&) = delete;

  /// Adds a job. `work` is called on the jobs' thread; then deliver() calls done(result of work), or
  /// failed(message) if `work` throws.
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

  /// Passes the waiting results to their callbacks.
  void deliver();
  /// Returns true if no job waits or runs, and all results were delivered.
  [[nodiscard]] bool is_idle() const { return pending_ == 0; }

 private:
  using Result = std::function<void()>;
  using Job = std::function<Result()>;

  std::function<void()> on_result_;
  int pending_ = 0;  ///< jobs whose result was not handed over
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
