// ladder.hpp: several knobs turned at once, those first that give the most for the least.
#pragma once
#include <cstddef>
#include <vector>

#include "app/evaluation/pareto/setting_summary.hpp"

namespace roomradar {

/// Mixtures that are worth a measurement, after single turns were measured: one knob after the other turned
/// to what is faster, in the order of the loss that each brought alone for the time that it saved; and
/// likewise to what is better, in the order of the time that it took. Each step keeps the turns before it;
/// a knob that was turned farther stays so. From what was measured once it cannot be told how turns go
/// together: the steps are to be measured, too.
/// @param defaults  the default's place among the summaries
/// @return up to `count` settings, evenly chosen along both ways, without those among the summaries
std::vector<Setting> greedy_settings(const MeasuredWork& work, const std::vector<SettingSummary>& summaries,
                                     std::size_t defaults, std::size_t count);

}  // namespace roomradar
