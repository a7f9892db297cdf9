// choose_presets.hpp: selects the settings of a sweep that become presets.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/evaluation/pareto/setting_summary.hpp"

namespace roomradar {

/// Returns a setting's loss: its errors relative to the default's, as the geometric mean over the kError
/// figures of (error + negligible) / (default's error + negligible). 1 for the default; NaN if nothing was
/// measured or the setting is not complete.
double loss_of(const MeasuredWork& work, const SettingSummary& setting, const SettingSummary& defaults);

/// Returns the largest of the ratios averaged by loss_of().
double worst_loss_of(const MeasuredWork& work, const SettingSummary& setting, const SettingSummary& defaults);

/// Indices of the chosen settings among the summaries.
struct PresetChoice {
  std::vector<std::size_t> front;  ///< Pareto front of time and loss, fastest first
  std::optional<std::size_t> fast, balanced, accurate;
};

inline constexpr double kMostWorstLoss = 10.0;  ///< max ratio of any error to the default's, on the front
inline constexpr double kMostWorstLossOfPreset = 3.0;
inline constexpr double kMostLossOfFast = 1.5, kMostLossOfBalanced = 1.1;
inline constexpr double kMostTimeOfAccurate = 3.0;   ///< max time relative to the default's
inline constexpr double kMostLossOfAccurate = 0.99;  ///< max loss; a smaller gain may be chance

/// Computes the Pareto front of time ratio and loss over complete settings with the default load. Presets
/// come from a second front, over settings with no error above kMostWorstLossOfPreset times the default's;
/// worse settings serve only budgets that cannot be met otherwise.
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
