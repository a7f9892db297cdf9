// greedy_search.hpp: greedy search for combinations of parameters, ordered by gain per cost.
#pragma once
#include <cstddef>
#include <vector>

#include "app/evaluation/pareto/setting_summary.hpp"

namespace roomradar {

/// Returns combinations worth measuring, after changes of single parameters were measured. One sequence
/// applies faster values in order of loss per time saved; the other applies more accurate values in order of
/// time per loss avoided. Each step keeps the changes before it, and a parameter never moves back towards its
/// default. The steps must be measured too: single changes do not tell how combined ones interact.
/// @param defaults  index of the default among the summaries
/// @return up to `count` settings, spread evenly along both sequences, without those already among the
/// summaries
std::vector<Setting> greedy_settings(const MeasuredWork& work, const std::vector<SettingSummary>& summaries,
                                     std::size_t defaults, std::size_t count);

}  // namespace roomradar
