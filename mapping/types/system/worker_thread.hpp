// worker_thread.hpp: a worker thread that runs one task in parallel with the caller's; priority of threads.
#pragma once
#include <sched.h>
#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <exception>
#include <set>
#include <thread>

namespace roomradar {

/// Lowers the priority of a thread of this process. Threads that it starts later inherit the low priority.
/// The priority cannot be raised again.
/// @param thread  0: the calling thread
/// @param nice    0: as usual; 19: lowest
void lower_priority(pid_t thread = 0, int nice = 10);

/// Returns the threads of this process.
std::set<pid_t> threads_of_process();

/// Owns a thread that sleeps between calls of run(). On a machine with one processor there is no thread, and
/// the two tasks run one after the other. Results must not depend on the order of the tasks. Call run() from
/// one thread only, and not from inside run(). If the worker last ran on the caller's processor, run() moves
/// the worker to another one.
class WorkerThread {
 public:
  WorkerThread();
  ~WorkerThread();
  WorkerThread(const WorkerThread&) = delete;
  WorkerThread& operator=(const WorkerThread&) = delete;

  /// Calls here() on the caller's thread and beside() on the worker thread, and waits until both are done.
  /// Then rethrows an exception of either task. If both threw, rethrows that of here().
  template <typename Here, typename Beside>
  void run(const Here& here, const Beside& beside) {
    start([](const void* work) { (*static_cast<const Beside*>(work))(); }, &beside);
    std::exception_ptr fault;
    try {
      here();
    } catch (...) {
      fault = std::current_exception();
    }
    finish();
    if (!fault) fault = fault_;
    if (fault) std::rethrow_exception(fault);
  }

  /// Calls work(i) for each i in 0..count-1, on both threads. Each i goes to the next idle thread, so results
  /// must not depend on the order.
  template <typename Work>
  void run_each(std::size_t count, const Work& work) {
    std::atomic<std::size_t> next = 0;
    const auto take = [&] {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    };
    run(take, take);
  }

 private:
  enum State : int { kIdle, kWork, kStop };
  using Call = void (*)(const void*);

  std::atomic<int> state_{kIdle};
  Call call_ = nullptr;
  const void* work_ = nullptr;
  std::exception_ptr fault_;        ///< thrown by the last call's beside()
  cpu_set_t allowed_{};             ///< processors that the constructing thread may use
  std::atomic<int> processor_{-1};  ///< on which the worker ran last
  std::thread thread_;              ///< declared last because it uses the members above

  void start(Call call, const void* work);
  void keep_apart();
  void finish();
  void serve();
  void do_work() noexcept;
};

/// Calls work(i) for each i in 0..count-1, shared with the worker unless it is null.
template <typename Work>
void run_each(WorkerThread* worker, std::size_t count, const Work& work) {
  if (worker != nullptr && count > 1) return worker->run_each(count, work);
  for (std::size_t i = 0; i < count; ++i) work(i);
}

}  // namespace roomradar
