// trade_page.hpp: writes a sweep's HTML file: plots of fronts, tables of presets, and explanations.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/evaluation/pareto/choose_presets.hpp"

namespace roomradar {

/// One kind of work with all its measurements.
struct TradeResult {
  MeasuredWork work = {};
  std::vector<Setting> settings = {};
  std::vector<SweepRow> rows = {};
  std::vector<SettingSummary> summaries = {};
  std::size_t defaults = 0;  ///< index of the default among the settings
  PresetChoice choice = {};
  bool was_cut_short = false;  ///< not all settings were measured in all scenes
  std::string fault = {};      ///< reason, unless the user stopped the sweep
};

/// Returns a line for each setting that failed: setting, scene and reason.
std::vector<std::string> faults_of(const TradeResult& result);

/// Writes a self-contained file that needs no network, in the light or dark theme of the reader's system.
/// Does nothing if the path is empty. Throws Error if it cannot be written.
/// @param about  lines on machine, renderer, seed and scenes
void write_trade_page(const std::vector<TradeResult>& results, const std::vector<std::string>& about,
                      const std::filesystem::path& path);

}  // namespace roomradar
