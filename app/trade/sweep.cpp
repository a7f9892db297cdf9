// sweep.cpp: default, setting, default, setting, default.
#include "app/trade/sweep.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "app/sim/counter_random.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

/// At random, but the default before all others: what is stopped early can still be compared with it.
std::vector<std::size_t> order_of(const std::vector<Setting>& settings, const Setting& usual,
                                  CounterRandom& random) {
  std::vector<std::size_t> order(settings.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto j = static_cast<std::size_t>(random.uniform() * static_cast<double>(i + 1));
    order[i] = order[j];
    order[j] = i;
  }
  std::partition(order.begin(), order.end(), [&](std::size_t i) { return settings[i] == usual; });
  return order;
}

/// What there is when the sweep is stopped in a scene: the scenes before it, all settings of which were
/// measured; where there is none, what there is of this one.
std::vector<SweepRow> stopped_in(std::size_t scene, std::vector<SweepRow> rows) {
  if (!rows.empty() && rows.front().scene < scene)
    std::erase_if(rows, [scene](const SweepRow& row) { return row.scene == scene; });
  return rows;
}

}  // namespace

std::vector<SweepRow> sweep(const TradeWork& work, const SweepPlan& plan, const SweepWatch& watch) {
  const auto is_stopped = [&] { return watch.is_stopped && watch.is_stopped(); };
  std::vector<SweepRow> rows;
  const Setting usual = usual_setting(work.knobs);
  for (std::size_t scene = 0; scene < work.scenes.size(); ++scene) {
    if (is_stopped()) return rows;
    const Measure measure = work.open(scene);
    /// Nothing where the sweep was stopped meanwhile: Ctrl-C ends a measurement's process, too.
    const auto measure_default = [&]() -> std::optional<Readings> {
      if (is_stopped()) return std::nullopt;
      try {
        return measure(usual);
      } catch (const Error&) {
        if (!is_stopped()) throw;
        return std::nullopt;
      }
    };
    for (int repeat = 0; repeat < plan.repeats; ++repeat) {
      CounterRandom random(plan.seed, static_cast<std::uint64_t>(repeat) + 1000 * scene);
      std::optional<Readings> before = measure_default();
      for (const std::size_t setting : order_of(plan.settings, usual, random)) {
        if (!before) return stopped_in(scene, std::move(rows));
        SweepRow row{.setting = setting, .scene = scene, .repeat = repeat};
        try {
          row.figures = measure(plan.settings[setting]);
        } catch (const Error& error) {
          if (plan.settings[setting] == usual && !is_stopped()) throw;
          row.fault = error.what();
          row.figures.assign(work.figures.size(), std::numeric_limits<double>::quiet_NaN());
        }
        std::optional<Readings> after = measure_default();
        if (!after) return stopped_in(scene, std::move(rows));
        for (std::size_t i = 0; i < row.figures.size(); ++i)
          row.ratios.push_back(row.figures[i] / (0.5 * ((*before)[i] + (*after)[i])));
        row.default_before = std::exchange(*before, *after);
        row.default_after = std::move(*after);
        if (watch.on_row) watch.on_row(row);
        rows.push_back(std::move(row));
      }
    }
  }
  return rows;
}

}  // namespace roomradar
