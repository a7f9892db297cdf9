// sweep.hpp: measures settings in random order, each between two measurements of the default.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/evaluation/pareto/measured_setting.hpp"

namespace roomradar {

/// One measurement of a setting.
struct SweepRow {
  std::size_t setting = 0;  ///< index among the plan's settings
  std::size_t scene = 0;    ///< index among the work's scenes
  int repeat = 0;           ///< index of the repetition, from 0
  Readings figures = {};
  /// Figures of the default, measured just before and after.
  Readings default_before = {}, default_after = {};
  /// Per figure: the setting's value / mean of the default's two values.
  Readings ratios = {};
  std::string fault = {};  ///< reason of a failure; the figures are then NaN
};

struct SweepPlan {
  std::vector<Setting> settings;
  int repeats = 1;
  std::uint64_t seed = 1;  ///< seed of the random order
};

struct SweptRows {
  std::vector<SweepRow> rows;
  std::string fault;  ///< reason of an early end; empty if complete, or stopped on request
};

struct SweepWatch {
  std::function<void(const SweepRow& row)> on_row;  ///< called after each measurement; may be empty
  std::function<bool()> is_stopped;                 ///< called before each measurement; may be empty
};

/// Measures all settings, per scene and repetition, in a new random order each time, the default's own row
/// first. The default is also measured between any two settings, and each setting is compared with the
/// default before and after it. A machine that slows down for a while thus slows all three.
///
/// A failing setting's row has the fault, and the sweep goes on. The sweep ends early if it is stopped, the
/// default fails, a scene cannot be opened, or on_row throws Error. It then returns the rows of completed
/// scenes, or those of the first scene if none is complete.
SweptRows sweep(const MeasuredWork& work, const SweepPlan& plan, const SweepWatch& watch = {});

}  // namespace roomradar
