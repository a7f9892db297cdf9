// parallel_for.hpp: distributes independent work items over the process's pool of threads.
#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <thread>

namespace roomradar {

inline constexpr unsigned kMaxThreads = 8;  ///< more threads are no faster: memory bandwidth is the limit

/// Returns the number of processors that this process may use, at most kMaxThreads.
inline unsigned hardware_threads() {
  return std::clamp(std::thread::hardware_concurrency(), 1U, kMaxThreads);
}

/// Returns `given` if > 0, else the number of processors.
inline int given_or_processors(int given) {
  return given > 0 ? given : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Calls work(piece, thread) for each piece in 0..pieces-1, on the caller and up to `threads` - 1 threads of
/// TBB's pool, which OpenCV uses, too. `thread` is below `threads` and differs between concurrent calls. Idle
/// threads take the next piece, so results must not depend on the order of the pieces. Waits for all threads,
/// and rethrows an exception of `work`. A caller with lowered priority (lower_priority()), and a child of
/// fork(), gets threads of its own, of the same priority. The caller may hold a lock: while it waits, it
/// executes no work of other calls of this function.
void parallel_for(std::size_t pieces, unsigned threads,
                  const std::function<void(std::size_t piece, unsigned thread)>& work);

/// Calls work(begin, end) for consecutive ranges of 0..count-1, each of at most `most` (> 0) numbers, on
/// hardware_threads() threads.
template <typename Work>
void parallel_ranges(std::size_t count, std::size_t most, const Work& work) {
  parallel_for((count + most - 1) / most, hardware_threads(),
               [&](std::size_t piece, unsigned) { work(piece * most, std::min(count, (piece + 1) * most)); });
}

}  // namespace roomradar
