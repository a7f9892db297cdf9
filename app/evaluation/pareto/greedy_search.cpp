// greedy_search.cpp: applies single changes cumulatively, in order of their price.
#include "app/evaluation/pareto/greedy_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/evaluation/pareto/choose_presets.hpp"

namespace roomradar {
namespace {

struct Turn {
  std::size_t parameter, word;
  double price;
};

/// Returns the parameter in which a setting differs from the default, if it is the only one and not a load.
std::optional<std::size_t> changed_parameter(const std::vector<Parameter>& parameters,
                                             const Setting& setting) {
  std::optional<std::size_t> turned;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (setting[k] == parameters[k].defaults) continue;
    if (turned || parameters[k].is_load) return std::nullopt;
    turned = k;
  }
  return turned;
}

/// Applies the changes cumulatively to the default; skips those that would move a parameter back.
std::vector<Setting> steps_of(std::vector<Turn> turns, const Setting& defaults) {
  std::stable_sort(turns.begin(), turns.end(),
                   [](const Turn& a, const Turn& b) { return a.price < b.price; });
  std::vector<Setting> steps;
  Setting setting = defaults;
  for (const Turn& turn : turns) {
    const auto turned =
        static_cast<std::ptrdiff_t>(turn.word) - static_cast<std::ptrdiff_t>(defaults[turn.parameter]);
    const auto already = static_cast<std::ptrdiff_t>(setting[turn.parameter]) -
                         static_cast<std::ptrdiff_t>(defaults[turn.parameter]);
    if (std::abs(turned) <= std::abs(already)) continue;
    setting[turn.parameter] = turn.word;
    steps.push_back(setting);
  }
  return steps;
}

}  // namespace

std::vector<Setting> greedy_settings(const MeasuredWork& work, const std::vector<SettingSummary>& summaries,
                                     std::size_t defaults, std::size_t count) {
  constexpr double kLeastSaved = 0.005, kLeastGained = 0.002;  // log ratios; less is noise
  std::vector<Turn> faster, better;
  for (const SettingSummary& summary : summaries) {
    const std::optional<std::size_t> parameter = changed_parameter(work.parameters, summary.setting);
    const double saved = -std::log(summary.time_ratio);
    const double lost = std::log(loss_of(work, summary, summaries[defaults]));
    if (!parameter || !summary.is_complete || !std::isfinite(saved) || !std::isfinite(lost)) continue;
    const std::size_t word = summary.setting[*parameter];
    if (saved > kLeastSaved && word < work.parameters[*parameter].defaults)
      faster.push_back({*parameter, word, std::max(lost, 0.0) / saved});
    if (lost < -kLeastGained && word > work.parameters[*parameter].defaults)
      better.push_back({*parameter, word, std::max(-saved, 0.0) / -lost});
  }
  std::vector<Setting> steps = steps_of(std::move(better), summaries[defaults].setting);
  std::reverse(steps.begin(), steps.end());
  for (Setting& step : steps_of(std::move(faster), summaries[defaults].setting))
    steps.push_back(std::move(step));
  std::erase_if(steps, [&](const Setting& step) {
    return std::any_of(summaries.begin(), summaries.end(),
                       [&](const SettingSummary& summary) { return summary.setting == step; });
  });
  if (steps.size() <= count) return steps;
  std::vector<Setting> chosen;
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(steps[count == 1 ? steps.size() - 1 : i * (steps.size() - 1) / (count - 1)]);
  return chosen;
}

}  // namespace roomradar
