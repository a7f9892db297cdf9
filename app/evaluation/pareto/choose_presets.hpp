// choose_presets.hpp: which of a sweep's settings are worth a name.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/evaluation/pareto/setting_summary.hpp"

namespace roomradar {

/// How much larger a setting's errors are than the default's: the geometric mean over the work's errors of
/// (error + negligible) / (the default's + negligible). 1 for the default, NaN where nothing is known.
double loss_of(const MeasuredWork& work, const SettingSummary& setting, const SettingSummary& defaults);

/// The largest of the same ratios.
double worst_loss_of(const MeasuredWork& work, const SettingSummary& setting, const SettingSummary& defaults);

/// Places among the summaries.
struct PresetChoice {
  std::vector<std::size_t> front;  ///< nothing is both faster and has less loss; fastest first
  std::optional<std::size_t> fast, balanced, accurate;
};

inline constexpr double kMostWorstLoss = 10.0;  ///< on the front no error is more times the default's
inline constexpr double kMostWorstLossOfPreset = 3.0;
inline constexpr double kMostLossOfFast = 1.5, kMostLossOfBalanced = 1.1;
inline constexpr double kMostTimeOfAccurate = 3.0;   ///< times the default's
inline constexpr double kMostLossOfAccurate = 0.99;  ///< what is no better than this may be so by chance

/// The front of time ratio against loss, of complete settings of the usual load; and on the front of those
/// where no error is more than kMostWorstLossOfPreset times the default's (what goes farther is for a budget
/// that cannot be held otherwise),
///  fast      the least time with a loss of at most kMostLossOfFast,
///  balanced  the same with at most kMostLossOfBalanced: what is gained nearly for nothing,
///  accurate  the least loss that takes at most kMostTimeOfAccurate times the default; the default itself
///            where that is more than kMostLossOfAccurate.
/// @param defaults  the default's place among the summaries
PresetChoice choose_presets(const MeasuredWork& work, const std::vector<SettingSummary>& summaries,
                            std::size_t defaults);

/// "default", "fast", "balanced", "accurate": those that a setting is, `between` them; empty if it is none.
std::string names_of(std::size_t setting, std::size_t defaults, const PresetChoice& choice,
                     const std::string& between);

}  // namespace roomradar
