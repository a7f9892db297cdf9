// bench_times.hpp: times that a thread spent computing, and their percentiles.
#pragma once
#include <algorithm>
#include <cstddef>
#include <ctime>
#include <vector>

namespace roomradar::test {

/// What the wall clock would show on a machine that does nothing else.
inline double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Times {
  std::vector<double> samples_ms;
  [[nodiscard]] double percentile(double p) {
    std::sort(samples_ms.begin(), samples_ms.end());
    return samples_ms[static_cast<std::size_t>(p * static_cast<double>(samples_ms.size() - 1))];
  }
};

}  // namespace roomradar::test
