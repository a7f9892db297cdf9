// trade_page.hpp: one HTML file of a sweep: fronts as plots, presets as a table, and how to read them.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/evaluation/pareto/choose_presets.hpp"

namespace roomradar {

/// A work with all that was measured of it.
struct TradeResult {
  MeasuredWork work = {};
  std::vector<Setting> settings = {};
  std::vector<SweepRow> rows = {};
  std::vector<SettingSummary> summaries = {};
  std::size_t defaults = 0;  ///< the default's place among the settings
  PresetChoice choice = {};
  bool was_cut_short = false;  ///< before all settings had been measured in all scenes
  std::string fault = {};      ///< why it was, if not because the user wanted it so
};

/// A line for each setting that could not be measured somewhere: which, where and why.
std::vector<std::string> faults_of(const TradeResult& result);

/// Needs no network and no other file; light or dark as the reader's system is. Throws Error if it cannot be
/// written. Nothing is written for an empty path.
/// @param about  lines on machine, renderer, seed and scenes
void write_trade_page(const std::vector<TradeResult>& results, const std::vector<std::string>& about,
                      const std::filesystem::path& path);

}  // namespace roomradar
