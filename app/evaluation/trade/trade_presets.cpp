// trade_presets.cpp: converts settings of sweeps to qualities.
#include "app/evaluation/trade/trade_presets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "app/evaluation/trade/prescan_work.hpp"
#include "app/evaluation/trade/run_work.hpp"

namespace roomradar {
namespace {

const TradeResult* result_of(const std::vector<TradeResult>& results, const std::string& work) {
  const auto found = std::find_if(results.begin(), results.end(),
                                  [&](const TradeResult& result) { return result.work.name == work; });
  return found == results.end() ? nullptr : &*found;
}

/// Adds the figures that were measured.
void add_figures(const TradeResult& result, std::size_t setting, const std::string& before,
                 Figures& figures) {
  const SettingSummary& summary = result.summaries[setting];
  const auto add = [&](const std::string& name, double value) {
    if (std::isfinite(value)) figures[before + name] = value;
  };
  add("time_ratio", summary.time_ratio);
  add("loss", loss_of(result.work, summary, result.summaries[result.defaults]));
  for (std::size_t i = 0; i < result.work.figures.size(); ++i)
    add(result.work.figures[i].name, summary.figures[i]);
}

/// Returns the part's time ratio: the mean of its stages' ratios, weighted by their times in the default.
double part_ratio(const TradeResult& result, std::size_t setting, const std::vector<std::string>& stages) {
  constexpr double kLeast = 0.01;
  double sum = 0.0, whole = 0.0;
  for (const std::string& stage : stages) {
    const std::size_t figure = place_of(result.work, stage + "_ms");
    const double nominal_ms = result.summaries[result.defaults].figures[figure];
    const double ratio = result.summaries[setting].ratios[figure];
    if (!std::isfinite(nominal_ms) || !std::isfinite(ratio)) continue;
    sum += nominal_ms * ratio;
    whole += nominal_ms;
  }
  return whole > 0.0 ? std::max(kLeast, sum / whole) : 1.0;
}

FrontStep step_of(const TradeResult& run, std::size_t setting) {
  FrontStep step;
  const RunSetting made = run_setting_of(run.settings[setting]);
  step.run = made.quality;
  step.objects = made.objects;
  const auto set = [&](FramePart part, const std::vector<std::string>& stages) {
    step.part_ratios[index_of(part)] = part_ratio(run, setting, stages);
  };
  set(FramePart::kLocate, {"reduce", "locate", "expected", "foreground"});
  set(FramePart::kMesh, {"mesh"});
  set(FramePart::kPhysics, {"moved"});  // only frames that move objects, because predictions are for those
  set(FramePart::kCompose, {"compose"});
  add_figures(run, setting, "", step.figures);
  return step;
}

/// Returns the front and the presets, from slow to fast. A budget starts at any requested preset, so each
/// must be a step.
std::vector<std::size_t> front_with_presets(const TradeResult& run) {
  std::vector<std::size_t> settings = run.choice.front;
  for (const auto& preset : {run.choice.accurate, run.choice.balanced, run.choice.fast})
    if (preset && std::find(settings.begin(), settings.end(), *preset) == settings.end())
      settings.push_back(*preset);
  std::stable_sort(settings.begin(), settings.end(), [&](std::size_t a, std::size_t b) {
    return run.summaries[a].time_ratio > run.summaries[b].time_ratio;
  });
  return settings;
}

}  // namespace

Presets chosen_presets(const std::vector<TradeResult>& results,
                       const std::map<std::string, std::string>& made_by) {
  using Choice = std::optional<std::size_t> PresetChoice::*;
  constexpr std::array kNames{std::pair<const char*, Choice>{"fast", &PresetChoice::fast},
                              std::pair<const char*, Choice>{"balanced", &PresetChoice::balanced},
                              std::pair<const char*, Choice>{"accurate", &PresetChoice::accurate}};
  Presets presets;
  presets.made_by = made_by;
  const TradeResult* scan = result_of(results, "prescan");
  const TradeResult* run = result_of(results, "run");
  for (const auto& [name, chosen] : kNames) {
    Preset& preset = presets.presets[name];
    if (scan != nullptr && scan->choice.*chosen) {
      preset.scan = scan_quality_of(scan->settings[*(scan->choice.*chosen)]);
      add_figures(*scan, *(scan->choice.*chosen), "scan_", preset.figures);
    }
    if (run != nullptr && run->choice.*chosen) {
      preset.run = run_setting_of(run->settings[*(run->choice.*chosen)]).quality;
      add_figures(*run, *(run->choice.*chosen), "run_", preset.figures);
    }
  }
  if (run != nullptr)
    for (const std::size_t setting : front_with_presets(*run))
      presets.front.push_back(step_of(*run, setting));
  return presets;
}

}  // namespace roomradar
