// worker_thread.cpp: hands work to the worker thread and waits for it.
#include "mapping/types/system/worker_thread.hpp"

namespace roomradar {

WorkerThread::WorkerThread() {
  if (std::thread::hardware_concurrency() > 1) thread_ = std::thread([this] { serve(); });
}

WorkerThread::~WorkerThread() {
  if (!thread_.joinable()) return;
  state_.store(kStop);
  state_.notify_one();
  thread_.join();
}

void WorkerThread::start(Call call, const void* work) {
  call_ = call;
  work_ = work;
  fault_ = nullptr;
  if (!thread_.joinable()) return;
  state_.store(kWork);
  state_.notify_one();
}

void WorkerThread::finish() {
  if (!thread_.joinable()) return do_work();
  state_.wait(kWork);
}

void WorkerThread::serve() {
  for (;;) {
    state_.wait(kIdle);
    if (state_.load() == kStop) return;
    do_work();
    state_.store(kIdle);
    state_.notify_one();
  }
}

void WorkerThread::do_work() noexcept {
  try {
    call_(work_);
  } catch (...) {
    fault_ = std::current_exception();
  }
}

}  // namespace roomradar
