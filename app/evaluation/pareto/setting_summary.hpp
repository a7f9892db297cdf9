// setting_summary.hpp: what all measurements of a setting say together.
#pragma once
#include <cstddef>
#include <vector>

#include "app/evaluation/pareto/sweep.hpp"

namespace roomradar {

struct SettingSummary {
  Setting setting = {};
  int rows = 0;                                ///< measurements that came to their end
  double time_ratio = 0.0;                     ///< to the default measured beside it: median ...
  double least_ratio = 0.0, most_ratio = 0.0;  ///< ... and spread
  Readings ratios = {};                        ///< of each figure to the default's beside it: median
  /// Times and memory: the median of all rows. The rest: the mean of the scenes' means, where they know it.
  Readings figures = {};
  /// It was done in every scene in which any setting was: only such ones can be compared.
  bool is_complete = false;
};

/// One for each setting, in their order.
std::vector<SettingSummary> summarise(const MeasuredWork& work, const std::vector<Setting>& settings,
                                      const std::vector<SweepRow>& rows);

}  // namespace roomradar
