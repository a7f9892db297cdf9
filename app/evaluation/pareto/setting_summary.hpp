// setting_summary.hpp: summary of all measurements of each setting.
#pragma once
#include <cstddef>
#include <vector>

#include "app/evaluation/pareto/sweep.hpp"

namespace roomradar {

struct SettingSummary {
  Setting setting = {};
  int rows = 0;                                ///< number of successful measurements
  double time_ratio = 0.0;                     ///< median of time / default's time (SweepRow::ratios)
  double least_ratio = 0.0, most_ratio = 0.0;  ///< min and max of time / default's time
  Readings ratios = {};                        ///< per figure: median of SweepRow::ratios
  /// Per figure. kTime and kMemory: median of all rows. Other kinds: mean over each scene's rows, then mean
  /// over the scenes.
  Readings figures = {};
  /// True if the setting was measured in each scene in which any setting was measured. Only complete settings
  /// can be compared.
  bool is_complete = false;
};

/// Returns one summary per setting, in the order of `settings`.
std::vector<SettingSummary> summarise(const MeasuredWork& work, const std::vector<Setting>& settings,
                                      const std::vector<SweepRow>& rows);

}  // namespace roomradar
