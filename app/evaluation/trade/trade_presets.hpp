// trade_presets.hpp: converts a sweep's chosen settings to the presets used by `--preset` and `--budget-ms`.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "app/evaluation/trade/trade_page.hpp"
#include "app/quality/presets.hpp"

namespace roomradar {

/// Returns the presets fast, balanced and accurate with their figures, from the sweeps of prescan and run.
/// Also returns the run's front, from accurate to fast. If a sweep is missing or did not choose a preset of
/// this name, the preset has the default quality.
Presets chosen_presets(const std::vector<TradeResult>& results,
                       const std::map<std::string, std::string>& made_by);

}  // namespace roomradar
