// trade_presets.hpp: what a sweep chose, as the presets that `--preset` and `--budget-ms` read.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "app/evaluation/trade/trade_page.hpp"
#include "app/quality/presets.hpp"

namespace roomradar {

/// fast, balanced and accurate of the prescan's and the run's sweep, each with its figures, and the run's
/// front from accurate to fast. Where a kind of work was not swept, or has no such preset, the default
/// stands.
Presets chosen_presets(const std::vector<TradeResult>& results,
                       const std::map<std::string, std::string>& made_by);

}  // namespace roomradar
