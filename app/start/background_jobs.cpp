// background_jobs.cpp: a queue of jobs and a queue of results.
#include "app/start/background_jobs.hpp"

namespace roomradar {

BackgroundJobs::BackgroundJobs(std::function<void()> on_result)
    : on_result_(std::move(on_result)), thread_([this] { run_jobs(); }) {}

BackgroundJobs::~BackgroundJobs() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundJobs::push(Job job) {
  ++pending_;
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  changed_.notify_all();
}

void BackgroundJobs::deliver() {
  for (;;) {
    Result result;
    {
      const std::lock_guard lock(mutex_);
      if (results_.empty()) return;
      result = std::move(results_.front());
      results_.pop_front();
    }
    --pending_;
    result();
  }
}

void BackgroundJobs::run_jobs() {
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ends_ || !jobs_.empty(); });
      if (ends_) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    Result result = job();
    {
      const std::lock_guard lock(mutex_);
      results_.push_back(std::move(result));
    }
    on_result_();
  }
}

}  // namespace roomradar
