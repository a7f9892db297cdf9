// bench_times.hpp: CPU time of a thread, and quantiles of measurements.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <numeric>
#include <vector>

namespace roomradar::test {

/// CPU time of the calling thread; equals wall-clock time on an otherwise idle machine.
inline double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

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
