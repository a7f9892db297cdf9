// stage_times.hpp: per-frame run times of each stage of a pipeline.
#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roomradar {

struct StageSummary {
  std::size_t count = 0;
  double median_ms = 0.0;
  double p95_ms = 0.0;
  double p99_ms = 0.0;
  double max_ms = 0.0;
};

inline double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Collects wall-clock times by stage name in constant memory. Usage: `times.timed("fuse", [&] { fuse(...);
/// });`
class StageTimes {
 public:
  template <typename Work>
  decltype(auto) timed(std::string_view stage, Work&& work) {
    const Stop stop{*this, stage, std::chrono::steady_clock::now()};
    return std::forward<Work>(work)();
  }
  void add_ms(std::string_view stage, double elapsed_ms);
  /// Returns nearest-rank percentiles per stage, accurate to 0.3 % for times from 1 us to one hour. Count and
  /// maximum are exact. The map is empty if nothing was timed.
  [[nodiscard]] std::map<std::string, StageSummary> summaries() const;
  /// Calls work(stage, count, newest_ms) for each stage.
  template <typename Work>
  void visit_newest(Work&& work) const {
    for (const auto& [stage, samples] : stages_) work(stage, samples.count, samples.newest_ms);
  }

 private:
  struct Stop {
    StageTimes& times;
    std::string_view stage;
    std::chrono::steady_clock::time_point start;
    ~Stop() { times.add_ms(stage, ms_since(start)); }
  };
  struct Samples {
    std::size_t count = 0;
    float newest_ms = 0.0F, min_ms = 0.0F, max_ms = 0.0F;
    std::vector<std::uint32_t> histogram;  ///< logarithmic bins
  };
  std::map<std::string, Samples, std::less<>> stages_;
};

}  // namespace roomradar
