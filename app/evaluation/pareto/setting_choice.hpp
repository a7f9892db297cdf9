// setting_choice.hpp: which settings a sweep measures: some at random, then combinations of the best changes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/evaluation/pareto/measured_work.hpp"
#include "app/evaluation/pareto/setting_summary.hpp"

namespace roomradar {

/// Returns up to `count` different settings other than the default, in random order. The seed determines the
/// result.
///
/// Up to two thirds of the settings change a single parameter, to show its effect. If there are more such
/// changes, faster values of quality parameters come first, since fronts consist mostly of them. Among these
/// and among the others, values close to the default come first.
///
/// The other settings (combinations) change all quality parameters. The values of each parameter occur about
/// equally often. Combinations tend to pair fast values with fast ones and slow values with slow ones, since
/// mixed combinations are rarely on a front. Each value of a quality parameter occurs if there are at least
/// as many combinations as values. Fewer settings are returned if not enough different ones are found.
std::vector<Setting> draw_settings(const std::vector<Parameter>& parameters, std::size_t count,
                                   std::uint64_t seed);

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
