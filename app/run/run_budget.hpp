// run_budget.hpp: keeps a run within a time budget: its Pareto front of qualities, their use, and messages.
#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/quality/budget.hpp"
#include "app/quality/presets.hpp"
#include "app/session/script/script.hpp"

namespace roomradar {

/// Returns the steps that a run may use: `most`, then the steps of the presets' front that follow it. If
/// `most` is not in the front, the steps faster than the default follow. Fixed settings are the same in all
/// steps. Adjacent steps that become equal are merged; parts that are equal in adjacent steps get equal
/// ratios.
std::vector<FrontStep> front_for(const Presets& presets, const RunQuality& most, const FieldWords& fixed);

/// Returns the time of a monotonic clock.
double steady_ms();

class RunBudget {
 public:
  /// @param front        not empty; the run begins with its first step
  /// @param has_picture  false: the run makes no pictures at all
  /// @param now_ms       a clock
  RunBudget(std::vector<FrontStep> front, double budget_ms, bool has_picture,
            std::function<double()> now_ms = steady_ms);

  /// Callback for SessionConfig::watch.
  std::optional<RunQuality> before(FramePart part, const FrameLoad& load);
  /// Call after the frame. Returns its changes of quality, in order, as events without a frame number.
  std::vector<ScriptEvent> end_frame();
  /// Returns a message for the user if the step has changed since the last one, at most once per second.
  std::string news();
  /// Sets this radar in all steps, after the user has chosen it.
  void keep(const RadarConfig& radar);
  /// Returns the current differences from the run's first step, as "depth_stride 2, shadows off"; empty:
  /// none.
  [[nodiscard]] std::string given_up() const;
  /// Returns the budget, the numbers of frames over it and of changes, and the frames begun with each
  /// setting.
  [[nodiscard]] nlohmann::json report() const;

 private:
  std::vector<FrontStep> front_;
  BudgetConfig config_;
  BudgetState state_;
  std::function<double()> now_ms_;
  std::array<double, kFrameParts + 1> begun_ms_{};  ///< start times of the current frame's parts
  std::vector<ScriptEvent> changes_;                ///< in the current frame
  std::vector<std::int64_t> frames_at_;             ///< frames begun with each step
  std::int64_t frames_ = 0, frames_over_ = 0, all_changes_ = 0;
  std::size_t said_step_ = 0;
  double said_ms_ = 0.0;
};

}  // namespace roomradar
