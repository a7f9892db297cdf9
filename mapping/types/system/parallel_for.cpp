// parallel_for.cpp: one task per thread, which takes piece after piece.
#include "mapping/types/system/parallel_for.hpp"

#include <pthread.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <unistd.h>

#include <atomic>
#include <future>
#include <vector>

namespace roomradar {
namespace {

using Task = std::function<void(unsigned thread)>;

void run_in_pool(unsigned threads, const Task& task) {
  tbb::this_task_arena::isolate([&] {  // while it waits, the caller takes no other tasks
    tbb::task_group group;
    for (unsigned thread = 1; thread < threads; ++thread) group.run([&task, thread] { task(thread); });
    group.run_and_wait([&task] { task(0); });
  });
}

/// Starts threads, which inherit the caller's priority.
void run_on_new_threads(unsigned threads, const Task& task) {
  std::vector<std::future<void>> others;
  for (unsigned thread = 1; thread < threads; ++thread)
    others.push_back(std::async(std::launch::async, task, thread));
  task(0);
  for (std::future<void>& other : others) other.get();
}

/// Returns true if the calling thread has another priority than the process, see lower_priority().
bool has_own_priority() {
  return getpriority(PRIO_PROCESS, 0) != getpriority(PRIO_PROCESS, static_cast<id_t>(getpid()));
}

/// True in a child of fork(), which has the pool's state but not its threads: if the child used the pool, TBB
/// would abort at its exit.
std::atomic<bool> is_child_of_fork = false;
[[maybe_unused]] const int kIsRegistered = pthread_atfork(nullptr, nullptr, [] { is_child_of_fork = true; });

}  // namespace

void parallel_for(std::size_t pieces, unsigned threads,
                  const std::function<void(std::size_t piece, unsigned thread)>& work) {
  std::atomic<std::size_t> next = 0;
  const auto take_pieces = [&](unsigned thread) {
    for (std::size_t piece = next++; piece < pieces; piece = next++) work(piece, thread);
  };
  threads = static_cast<unsigned>(std::min<std::size_t>(threads, pieces));
  if (threads < 2) return take_pieces(0);
#if defined(__SANITIZE_THREAD__)
  const bool uses_pool = false;  // the thread sanitizer does not see how TBB synchronises
#else
  const bool uses_pool = !has_own_priority() && !is_child_of_fork;
#endif
  if (uses_pool)
    run_in_pool(threads, take_pieces);
  else
    run_on_new_threads(threads, take_pieces);
}

}  // namespace roomradar
