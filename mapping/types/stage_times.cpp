// stage_times.cpp: percentiles of the collected times.
#include "mapping/types/stage_times.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {

void StageTimes::add_ms(std::string_view stage, double elapsed_ms) {
  auto found = samples_ms_.find(stage);
  if (found == samples_ms_.end()) found = samples_ms_.emplace(std::string(stage), std::vector<float>{}).first;
  found->second.push_back(static_cast<float>(elapsed_ms));
}

std::map<std::string, StageSummary> StageTimes::summaries() const {
  std::map<std::string, StageSummary> result;
  for (const auto& [stage, samples_ms] : samples_ms_) {
    std::vector<float> sorted_ms = samples_ms;
    std::sort(sorted_ms.begin(), sorted_ms.end());
    const auto rank_ms = [&](double fraction) {
      const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted_ms.size())));
      return static_cast<double>(sorted_ms[std::max<std::size_t>(rank, 1) - 1]);
    };
    result[stage] = {sorted_ms.size(), rank_ms(0.5), rank_ms(0.95), rank_ms(0.99), sorted_ms.back()};
  }
  return result;
}

}  // namespace roomradar
