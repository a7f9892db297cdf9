// session_thread.cpp: one task at a time on a thread.
#include "app/c_api/session_thread.hpp"

#include <utility>

namespace roomradar::c_api {

SessionThread::SessionThread() : thread_([this] { serve(); }) {}

SessionThread::~SessionThread() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void SessionThread::run_and_wait(Call call, const void* task) {
  std::unique_lock lock(mutex_);
  call_ = call;
  task_ = task;
  is_done_ = false;
  changed_.notify_all();
  changed_.wait(lock, [this] { return is_done_; });
  if (const std::exception_ptr fault = std::exchange(fault_, nullptr)) std::rethrow_exception(fault);
}

void SessionThread::serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stops_ || call_ != nullptr; });
    if (call_ == nullptr) return;
    const Call work = std::exchange(call_, nullptr);
    lock.unlock();
    std::exception_ptr fault;
    try {
      work(task_);
    } catch (...) {
      fault = std::current_exception();
    }
    lock.lock();
    fault_ = fault;
    is_done_ = true;
    changed_.notify_all();
  }
}

}  // namespace roomradar::c_api
