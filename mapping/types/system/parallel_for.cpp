// parallel_for.cpp: a TBB task per thread, which takes piece after piece.
#include "mapping/types/system/parallel_for.hpp"

#include <atomic>

#if defined(__SANITIZE_THREAD__)
// The thread sanitizer does not see how TBB synchronises: each call starts threads of its own.
#include <future>
#include <vector>
namespace {
struct TaskGroup {
  std::vector<std::future<void>> tasks;
  template <typename Task>
  void run(const Task& task) {
    tasks.push_back(std::async(std::launch::async, task));
  }
  void wait() {
    for (std::future<void>& task : tasks) task.get();
  }
};
template <typename Work>
void isolate(const Work& work) {
  work();
}
}  // namespace
#else
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
using TaskGroup = tbb::task_group;
using tbb::this_task_arena::isolate;
#endif

namespace roomradar {

void parallel_for(std::size_t pieces, unsigned threads,
                  const std::function<void(std::size_t piece, unsigned thread)>& work) {
  std::atomic<std::size_t> next = 0;
  const auto take_pieces = [&](unsigned thread) {
    for (std::size_t piece = next++; piece < pieces; piece = next++) work(piece, thread);
  };
  if (threads < 2 || pieces < 2) return take_pieces(0);
  isolate([&] {
    TaskGroup group;
    for (unsigned thread = 0; thread < threads && thread < pieces; ++thread)
      group.run([&take_pieces, thread] { take_pieces(thread); });
    group.wait();  // the caller takes part
  });
}

}  // namespace roomradar
