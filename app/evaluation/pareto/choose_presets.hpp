// choose_presets.hpp: selects presets and Pareto front from the measured settings of a sweep.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/evaluation/pareto/setting_summary.hpp"

namespace roomradar {

/// Returns a setting's loss, that is, its mean error relative to the default setting. The loss is the
/// geometric mean of (error + negligible) / (default's error + negligible) over all metrics of kind kError.
/// `negligible` is the smallest relevant difference of the metric. The loss of the default is 1. Returns NaN
/// if no error was measured or the setting is not complete.
double loss_of(const MeasuredWork& work, const SettingSummary& setting, const SettingSummary& defaults);

/// Returns the largest of the error ratios that loss_of() averages.
double worst_loss_of(const MeasuredWork& work, const SettingSummary& setting, const SettingSummary& defaults);

/// The chosen settings, as indices in the summaries.
struct PresetChoice {
  std::vector<std::size_t> front;  ///< Pareto front of time ratio and loss, fastest first
  std::optional<std::size_t> fast, balanced, accurate;
};

inline constexpr double kMostWorstLoss = 10.0;  ///< max worst_loss_of() on the front
/// Max worst_loss_of() of a preset.
inline constexpr double kMostWorstLossOfPreset = 3.0;
/// Max losses of the presets fast and balanced.
inline constexpr double kMostLossOfFast = 1.5, kMostLossOfBalanced = 1.1;
inline constexpr double kMostTimeOfAccurate = 3.0;  ///< max time ratio of the preset accurate
/// Max loss of the preset accurate. A smaller gain may be random.
inline constexpr double kMostLossOfAccurate = 0.99;

/// Computes the Pareto front of time ratio and loss over complete settings whose load parameters have their
/// defaults. Presets come from a second front, over settings with worst_loss_of() <= kMostWorstLossOfPreset.
/// Settings above this limit are only on the first front, for time budgets that no better setting meets.
///   fast      least time with a loss of at most kMostLossOfFast
///   balanced  least time with a loss of at most kMostLossOfBalanced
///   accurate  least loss within kMostTimeOfAccurate times the default's time; the default itself if that
///             loss is not below kMostLossOfAccurate
/// @param defaults  index of the default among the summaries
PresetChoice choose_presets(const MeasuredWork& work, const std::vector<SettingSummary>& summaries,
                            std::size_t defaults);

/// Returns the names that apply to a setting ("default", "fast", "balanced", "accurate"), joined by
/// `between`; empty if none does.
std::string names_of(std::size_t setting, std::size_t defaults, const PresetChoice& choice,
                     const std::string& between);

}  // namespace roomradar
