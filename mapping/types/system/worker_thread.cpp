// worker_thread.cpp: hands work to the worker thread and waits for it.
#include "mapping/types/system/worker_thread.hpp"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace roomradar {

void lower_priority(pid_t thread, int nice) {
  static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(thread != 0 ? thread : gettid()), nice));
}

std::set<pid_t> threads_of_process() {
  std::set<pid_t> threads;
  std::error_code fault;
  for (std::filesystem::directory_iterator entry("/proc/self/task", fault), end; !fault && entry != end;
       entry.increment(fault))
    threads.insert(static_cast<pid_t>(std::atoi(entry->path().filename().c_str())));
  return threads;
}

WorkerThread::WorkerThread() {
  if (std::thread::hardware_concurrency() < 2) return;
  if (sched_getaffinity(0, sizeof allowed_, &allowed_) != 0) CPU_ZERO(&allowed_);
  thread_ = std::thread([this] { serve(); });
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
  keep_apart();
  state_.store(kWork);
  state_.notify_one();
}

/// Linux wakes a thread where it ran last or on the waker's processor. If these are the same, a kernel with
/// few processors does not look for an idle one, and the two tasks would take turns.
void WorkerThread::keep_apart() {
  const int here = sched_getcpu();
  if (here < 0 || here >= CPU_SETSIZE || here != processor_.load()) return;
  cpu_set_t others = allowed_;
  CPU_CLR(here, &others);
  if (CPU_COUNT(&others) > 0) pthread_setaffinity_np(thread_.native_handle(), sizeof others, &others);
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
    processor_.store(sched_getcpu());
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
