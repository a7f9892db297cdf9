// sweep.hpp: measures settings in random order, each between two measurements of the default setting.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/evaluation/pareto/measured_work.hpp"

namespace roomradar {

/// One measurement of a setting.
struct SweepRow {
  std::size_t setting = 0;  ///< index in SweepPlan::settings
  std::size_t scene = 0;    ///< index in MeasuredWork::scenes
  int repeat = 0;           ///< index of the repetition, from 0
  Readings figures = {};
  /// Figures of the default setting, measured immediately before and after this setting.
  Readings default_before = {}, default_after = {};
  /// Per figure: the setting's value divided by the mean of the default's two values.
  Readings ratios = {};
  std::string fault = {};  ///< reason why the measurement failed; `figures` are then NaN
};

struct SweepPlan {
  std::vector<Setting> settings;
  int repeats = 1;
  std::uint64_t seed = 1;  ///< seed of the random order
};

struct SweptRows {
  std::vector<SweepRow> rows;
  std::string fault;  ///< reason of an early end; empty if complete or stopped by is_stopped
};

struct SweepWatch {
  std::function<void(const SweepRow& row)> on_row;  ///< called after each measurement; may be empty
  /// Called before each measurement. True ends the sweep. May be empty.
  std::function<bool()> is_stopped;
};

/// Measures all settings in each scene and repetition, each time in a new random order that begins with the
/// default. The default is also measured between any two settings. Each setting is compared with the default
/// measured before and after it, so that a temporary slowdown of the machine affects all three measurements.
///
/// If a setting fails, its row contains the fault, and the sweep continues. The sweep ends early if
/// is_stopped returns true, the default fails, a scene cannot be opened, or on_row throws Error. Then only
/// the rows of completed scenes are returned, or those of the first scene if no scene is complete.
SweptRows sweep(const MeasuredWork& work, const SweepPlan& plan, const SweepWatch& watch = {});

}  // namespace roomradar
