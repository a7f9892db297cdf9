// greedy_search.hpp: greedy search for combinations of parameter values, ordered by gain per cost.
#pragma once
#include <cstddef>
#include <vector>

#include "app/evaluation/pareto/setting_summary.hpp"

namespace roomradar {

/// Returns combinations of parameter values to measure next, from measured changes of single parameters. Two
/// sequences of combinations start at the default. One applies faster values, in order of loss per time
/// saved. The other applies more accurate values, in order of time per loss avoided. Changes that save less
/// than 0.5 % of the time, or avoid less than 0.2 % of the loss, are ignored as noise. Each combination
/// contains all changes of the previous one or a larger change of the same parameter. The combinations must
/// be measured, since changes may interact.
/// @param defaults  index of the default in the summaries
/// @return up to `count` settings, evenly distributed along both sequences, without settings in `summaries`
std::vector<Setting> greedy_settings(const MeasuredWork& work, const std::vector<SettingSummary>& summaries,
                                     std::size_t defaults, std::size_t count);

}  // namespace roomradar
