// gl_thread.cpp: work handed to a thread, one piece at a time.
#include "radar/gl/gl_thread.hpp"

#include <utility>

namespace roomradar {

GlThread::GlThread() : thread_([this] { serve(); }) {}

GlThread::~GlThread() {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void GlThread::run(const std::function<void()>& work) {
  const std::lock_guard caller(callers_);
  std::unique_lock lock(mutex_);
  work_ = &work;
  changed_.notify_all();
  changed_.wait(lock, [this] { return work_ == nullptr; });
  if (const std::exception_ptr fault = std::exchange(fault_, nullptr)) std::rethrow_exception(fault);
}

void GlThread::serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return work_ != nullptr || is_stopping_; });
    if (work_ == nullptr) return;
    lock.unlock();
    std::exception_ptr fault;
    try {
      (*work_)();
    } catch (...) {
      fault = std::current_exception();
    }
    lock.lock();
    fault_ = fault;
    work_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace roomradar
