// sweep.cpp: measures default, setting, default, setting, default.
#include "app/evaluation/pareto/sweep.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Returns a random order with the default first, so an interrupted sweep can be compared with it.
std::vector<std::size_t> order_of(const std::vector<Setting>& settings, const Setting& defaults,
                                  CounterRandom& random) {
  std::vector<std::size_t> order(settings.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto j = static_cast<std::size_t>(random.uniform() * static_cast<double>(i + 1));
    order[i] = order[j];
    order[j] = i;
  }
  std::partition(order.begin(), order.end(), [&](std::size_t i) { return settings[i] == defaults; });
  return order;
}

/// Returns the rows of a sweep that ended in a scene: those of the completed scenes before it, or if there
/// are none, all rows.
std::vector<SweepRow> stopped_in(std::size_t scene, std::vector<SweepRow> rows) {
  if (!rows.empty() && rows.front().scene < scene)
    std::erase_if(rows, [scene](const SweepRow& row) { return row.scene == scene; });
  return rows;
}

bool is_stopped(const SweepWatch& watch) { return watch.is_stopped && watch.is_stopped(); }

/// Returns false if the sweep was stopped. Throws Error if the default cannot be measured.
bool measure_scene(const MeasuredWork& work, const SweepPlan& plan, const SweepWatch& watch,
                   std::size_t scene, std::vector<SweepRow>& rows) {
  const Setting defaults = default_setting(work.parameters);
  const Measure measure = work.open(scene);
  for (int repeat = 0; repeat < plan.repeats; ++repeat) {
    CounterRandom random(plan.seed, static_cast<std::uint64_t>(repeat) + 1000 * scene);
    if (is_stopped(watch)) return false;
    Readings before = measure(defaults);
    for (const std::size_t setting : order_of(plan.settings, defaults, random)) {
      if (is_stopped(watch)) return false;
      SweepRow row{.setting = setting, .scene = scene, .repeat = repeat};
      try {
        row.figures = measure(plan.settings[setting]);
      } catch (const Error& error) {
        if (plan.settings[setting] == defaults) throw;
        row.fault = error.what();
        row.figures.assign(work.figures.size(), std::numeric_limits<double>::quiet_NaN());
      }
      if (is_stopped(watch)) return false;
      const Readings after = measure(defaults);
      for (std::size_t i = 0; i < row.figures.size(); ++i)
        row.ratios.push_back(row.figures[i] / (0.5 * (before[i] + after[i])));
      row.default_before = std::exchange(before, after);
      row.default_after = after;
      rows.push_back(row);
      if (watch.on_row) watch.on_row(row);
    }
  }
  return true;
}

}  // namespace

SweptRows sweep(const MeasuredWork& work, const SweepPlan& plan, const SweepWatch& watch) {
  std::vector<SweepRow> rows;
  for (std::size_t scene = 0; scene < work.scenes.size(); ++scene) {
    try {
      if (!is_stopped(watch) && measure_scene(work, plan, watch, scene, rows)) continue;
      return {stopped_in(scene, std::move(rows)), {}};
    } catch (const Error& error) {
      // If stopped by Ctrl-C, the error is that of the interrupted child process.
      return {stopped_in(scene, std::move(rows)), is_stopped(watch) ? std::string() : error.what()};
    }
  }
  return {std::move(rows), {}};
}

}  // namespace roomradar
