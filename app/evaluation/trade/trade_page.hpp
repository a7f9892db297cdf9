// trade_page.hpp: writes a sweep's HTML file, with plots of fronts, tables of presets, and explanations.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/evaluation/pareto/choose_presets.hpp"

namespace roomradar {

/// One work with all its measurements.
struct TradeResult {
  MeasuredWork work = {};
  std::vector<Setting> settings = {};
  std::vector<SweepRow> rows = {};
  std::vector<SettingSummary> summaries = {};
  std::size_t defaults = 0;  ///< index of the default in `settings`
  PresetChoice choice = {};
  bool was_cut_short = false;  ///< true if not all settings were measured in all scenes
  bool is_by_jobs = false;     ///< true: measured by concurrent jobs, so times are not comparable
  std::string fault = {};      ///< reason of an early end; empty if the user stopped the sweep
};

/// Returns a line with setting, scene and reason for each failed measurement.
std::vector<std::string> faults_of(const TradeResult& result);

/// Writes a self-contained file that loads nothing from the network. Browsers show it in their light or dark
/// theme. Does nothing if `path` is empty. Throws Error if the file cannot be written.
/// @param about  lines of text on machine, renderer, seed and scenes
void write_trade_page(const std::vector<TradeResult>& results, const std::vector<std::string>& about,
                      const std::filesystem::path& path);

}  // namespace roomradar
