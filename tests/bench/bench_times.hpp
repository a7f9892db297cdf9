// bench_times.hpp: clocks, and quantiles of measurements.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <numeric>
#include <vector>

namespace roomradar::test {

inline double clock_ms(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}
/// CPU time of the calling thread; equals wall-clock time on an otherwise idle machine.
inline double thread_ms() { return clock_ms(CLOCK_THREAD_CPUTIME_ID); }
/// CPU time of all threads of this process.
inline double process_ms() { return clock_ms(CLOCK_PROCESS_CPUTIME_ID); }
inline double wall_ms() { return clock_ms(CLOCK_MONOTONIC); }

/// Quantile by nearest rank, `part` in 0..1; 0 for no values.
inline double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  const auto at = std::lround(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

struct Times {
  std::vector<double> samples_ms;
  [[nodiscard]] double percentile(double part) const { return quantile(samples_ms, part); }
  /// 0 for no samples.
  [[nodiscard]] double mean() const {
    const double sum = std::accumulate(samples_ms.begin(), samples_ms.end(), 0.0);
    return samples_ms.empty() ? 0.0 : sum / static_cast<double>(samples_ms.size());
  }
};

}  // namespace roomradar::test
