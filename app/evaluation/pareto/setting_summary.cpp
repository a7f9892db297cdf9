// setting_summary.cpp: medians of noisy figures, means of the others.
#include "app/evaluation/pareto/setting_summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace roomradar {
namespace {

double median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return kNotMeasured;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  int count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : kNotMeasured;
}

double figure_of(const std::vector<const SweepRow*>& rows, std::size_t figure, FigureKind kind) {
  if (kind == FigureKind::kTime || kind == FigureKind::kMemory) {
    std::vector<double> values;
    for (const SweepRow* row : rows) values.push_back(row->figures[figure]);
    return median(values);
  }
  std::map<std::size_t, std::vector<double>> of_scene;
  for (const SweepRow* row : rows) of_scene[row->scene].push_back(row->figures[figure]);
  std::vector<double> means;
  for (const auto& [scene, values] : of_scene) means.push_back(mean(values));
  return mean(means);
}

}  // namespace

std::vector<SettingSummary> summarise(const MeasuredWork& work, const std::vector<Setting>& settings,
                                      const std::vector<SweepRow>& rows) {
  std::vector<std::vector<const SweepRow*>> rows_of(settings.size());
  std::vector<std::set<std::size_t>> scenes_of(settings.size());
  std::set<std::size_t> scenes;
  for (const SweepRow& row : rows) {
    if (!row.fault.empty()) continue;
    rows_of[row.setting].push_back(&row);
    scenes_of[row.setting].insert(row.scene);
    scenes.insert(row.scene);
  }
  std::vector<SettingSummary> summaries;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    SettingSummary summary{.setting = settings[i]};
    summary.rows = static_cast<int>(rows_of[i].size());
    summary.is_complete = !scenes.empty() && scenes_of[i] == scenes;
    std::vector<double> ratios;
    for (const SweepRow* row : rows_of[i]) ratios.push_back(row->ratios[work.time]);
    summary.time_ratio = median(ratios);
    summary.least_ratio = ratios.empty() ? kNotMeasured : *std::min_element(ratios.begin(), ratios.end());
    summary.most_ratio = ratios.empty() ? kNotMeasured : *std::max_element(ratios.begin(), ratios.end());
    for (std::size_t figure = 0; figure < work.figures.size(); ++figure) {
      summary.figures.push_back(figure_of(rows_of[i], figure, work.figures[figure].kind));
      std::vector<double> of_figure;
      for (const SweepRow* row : rows_of[i]) of_figure.push_back(row->ratios[figure]);
      summary.ratios.push_back(median(of_figure));
    }
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

}  // namespace roomradar
