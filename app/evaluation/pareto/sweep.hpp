// sweep.hpp: settings measured in random order, each between two measurements of the default.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/evaluation/pareto/measured_setting.hpp"

namespace roomradar {

/// One setting, measured once.
struct SweepRow {
  std::size_t setting = 0;  ///< among the sweep's
  std::size_t scene = 0;    ///< among the work's
  int repeat = 0;           ///< from 0
  Readings figures = {};
  Readings default_before = {}, default_after = {};  ///< the default's figures just before and just after
  /// Of each figure the setting's over the mean of both.
  Readings ratios = {};
  std::string fault = {};  ///< why it could not be done; the figures are then NaN
};

struct SweepPlan {
  std::vector<Setting> settings;
  int repeats = 1;
  std::uint64_t seed = 1;  ///< of the order
};

struct SweptRows {
  std::vector<SweepRow> rows;
  std::string fault;  ///< why it ended before all was measured; empty if it did not, or was stopped
};

struct SweepWatch {
  std::function<void(const SweepRow& row)> on_row;  ///< as soon as a row is there; may be empty
  std::function<bool()> is_stopped;                 ///< asked before each measurement; may be empty
};

/// Scene by scene, and in a scene repeat by repeat, all settings in an order of their own, the default's own
/// row first. Between any two the default is measured, and each setting is compared with the one before and
/// the one after it: a machine that becomes slower, or has other work for a while, slows all three. Where a
/// setting cannot be done its row says why and the sweep goes on. Where it is stopped, or the default cannot
/// be done, or a scene not opened, or on_row throws, the scenes that were done are given, or what is done of
/// the first.
SweptRows sweep(const MeasuredWork& work, const SweepPlan& plan, const SweepWatch& watch = {});

}  // namespace roomradar
