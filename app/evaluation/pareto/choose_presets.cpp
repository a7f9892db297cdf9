// choose_presets.cpp: combines all errors to a loss, and selects presets from its front.
#include "app/evaluation/pareto/choose_presets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/evaluation/pareto/pareto_front.hpp"

namespace roomradar {
namespace {

std::vector<double> error_ratios(const MeasuredWork& work, const SettingSummary& setting,
                                 const SettingSummary& defaults) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < work.figures.size(); ++i) {
    const FigureName& figure = work.figures[i];
    if (figure.kind != FigureKind::kError) continue;
    const double ratio = (setting.figures[i] + figure.negligible) / (defaults.figures[i] + figure.negligible);
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  return ratios;
}

}  // namespace

double loss_of(const MeasuredWork& work, const SettingSummary& setting, const SettingSummary& defaults) {
  const std::vector<double> ratios = error_ratios(work, setting, defaults);
  if (ratios.empty() || !setting.is_complete) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (const double ratio : ratios) sum += std::log(ratio);
  return std::exp(sum / static_cast<double>(ratios.size()));
}

double worst_loss_of(const MeasuredWork& work, const SettingSummary& setting,
                     const SettingSummary& defaults) {
  const std::vector<double> ratios = error_ratios(work, setting, defaults);
  return ratios.empty() ? std::numeric_limits<double>::quiet_NaN()
                        : *std::max_element(ratios.begin(), ratios.end());
}

PresetChoice choose_presets(const MeasuredWork& work, const std::vector<SettingSummary>& summaries,
                            std::size_t defaults) {
  const auto points_with = [&](double most_worst_loss) {
    std::vector<CostAndError> points;
    for (const SettingSummary& summary : summaries) {
      CostAndError point{std::numeric_limits<double>::quiet_NaN(),
                         loss_of(work, summary, summaries[defaults])};
      if (summary.is_complete && has_default_load(work.parameters, summary.setting) &&
          worst_loss_of(work, summary, summaries[defaults]) <= most_worst_loss)
        point.cost = summary.time_ratio;
      points.push_back(point);
    }
    return points;
  };
  PresetChoice choice;
  choice.front = pareto_front_of(points_with(kMostWorstLoss));
  const std::vector<CostAndError> points = points_with(kMostWorstLossOfPreset);
  const auto is_better = [&](const std::optional<std::size_t>& best, std::size_t i, const auto& measure) {
    return !best || measure(points[i]) < measure(points[*best]);
  };
  const auto cost = [](const CostAndError& p) { return p.cost; };
  const auto error = [](const CostAndError& p) { return p.error; };
  for (const std::size_t i : pareto_front_of(points)) {
    if (points[i].error <= kMostLossOfFast && is_better(choice.fast, i, cost)) choice.fast = i;
    if (points[i].error <= kMostLossOfBalanced && is_better(choice.balanced, i, cost)) choice.balanced = i;
    if (points[i].cost <= kMostTimeOfAccurate && is_better(choice.accurate, i, error)) choice.accurate = i;
  }
  if (choice.accurate && !(points[*choice.accurate].error < kMostLossOfAccurate)) {
    choice.accurate.reset();
    if (std::isfinite(points[defaults].cost)) choice.accurate = defaults;
  }
  return choice;
}

std::string names_of(std::size_t setting, std::size_t defaults, const PresetChoice& choice,
                     const std::string& between) {
  std::string names;
  const auto add = [&](bool is_it, const char* name) {
    if (is_it) names += (names.empty() ? "" : between) + name;
  };
  add(setting == defaults, "default");
  add(choice.fast == setting, "fast");
  add(choice.balanced == setting, "balanced");
  add(choice.accurate == setting, "accurate");
  return names;
}

}  // namespace roomradar
