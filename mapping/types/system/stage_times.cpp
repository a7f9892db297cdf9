// stage_times.cpp: log histograms of times, and percentiles from them.
#include "mapping/types/system/stage_times.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

constexpr double kFinest_ms = 1e-3;
constexpr int kBinsPerOctave = 128, kOctaves = 32;
constexpr std::size_t kBins = std::size_t{kBinsPerOctave} * kOctaves;

std::size_t bin_of(double elapsed_ms) {
  const double bin = std::floor(kBinsPerOctave * std::log2(std::max(elapsed_ms, kFinest_ms) / kFinest_ms));
  return static_cast<std::size_t>(std::min(bin, static_cast<double>(kBins - 1)));
}

double middle_ms(std::size_t bin) {
  return kFinest_ms * std::exp2((static_cast<double>(bin) + 0.5) / kBinsPerOctave);
}

}  // namespace

void StageTimes::add_ms(std::string_view stage, double elapsed_ms) {
  auto found = stages_.find(stage);
  if (found == stages_.end()) {
    found = stages_.emplace(std::string(stage), Samples{}).first;
    found->second.histogram.resize(kBins);
  }
  Samples& samples = found->second;
  const auto newest_ms = static_cast<float>(elapsed_ms);
  samples.min_ms = samples.count == 0 ? newest_ms : std::min(samples.min_ms, newest_ms);
  samples.max_ms = samples.count == 0 ? newest_ms : std::max(samples.max_ms, newest_ms);
  samples.newest_ms = newest_ms;
  ++samples.count;
  ++samples.histogram[bin_of(elapsed_ms)];
}

std::map<std::string, StageSummary> StageTimes::summaries() const {
  std::map<std::string, StageSummary> result;
  for (const auto& [stage, samples] : stages_) {
    const auto min_ms = static_cast<double>(samples.min_ms), max_ms = static_cast<double>(samples.max_ms);
    const auto rank_ms = [&, &samples = samples](double fraction) {
      const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(samples.count)));
      std::size_t bin = 0;
      for (std::size_t below = samples.histogram[0]; below < rank; below += samples.histogram[bin]) ++bin;
      return std::clamp(middle_ms(bin), min_ms, max_ms);
    };
    result[stage] = {samples.count, rank_ms(0.5), rank_ms(0.95), rank_ms(0.99), max_ms};
  }
  return result;
}

}  // namespace roomradar
