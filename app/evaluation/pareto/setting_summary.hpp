// setting_summary.hpp: summarises all measurements of each setting.
#pragma once
#include <cstddef>
#include <vector>

#include "app/evaluation/pareto/sweep.hpp"

namespace roomradar {

struct SettingSummary {
  Setting setting = {};
  int rows = 0;                                ///< number of successful measurements
  double time_ratio = 0.0;                     ///< median of time / default's time in the same measurement
  double least_ratio = 0.0, most_ratio = 0.0;  ///< range of that ratio
  Readings ratios = {};                        ///< per figure: median of value / default's value
  /// Times and memory: median of all rows. Other figures: mean over each scene's rows, then mean over the
  /// scenes.
  Readings figures = {};
  /// True if measured in every scene in which any setting was measured; only complete settings are
  /// comparable.
  bool is_complete = false;
};

/// Returns one summary per setting, in order.
std::vector<SettingSummary> summarise(const MeasuredWork& work, const std::vector<Setting>& settings,
                                      const std::vector<SweepRow>& rows);

}  // namespace roomradar
