// greedy_search.hpp: greedy search for combinations of parameters, ordered by gain per cost.
#pragma once
#include <cstddef>
#include <vector>

#include "app/evaluation/pareto/setting_summary.hpp"

namespace roomradar {

/// Returns combinations of parameter values to measure next, from measured changes of single parameters. One
/// sequence applies faster values in order of loss per time saved; the other applies more accurate values in
/// order of time per loss avoided. Each step keeps the earlier changes, and a parameter never moves back
/// towards its default. The combinations must be measured, since changes may interact.
/// @param defaults  index of the default among the summaries
/// @return up to `count` settings, spread evenly along both sequences, without those already among the
/// summaries
std::vector<Setting> greedy_settings(const MeasuredWork& work, const std::vector<SettingSummary>& summaries,
                                     std::size_t defaults, std::size_t count);

}  // namespace roomradar
