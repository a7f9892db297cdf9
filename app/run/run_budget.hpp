// run_budget.hpp: keeps a run within a time budget per frame, by switching among quality settings on a Pareto
// front.
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

/// Returns the quality settings (steps) that a run may use: first `most`, then the steps of the presets'
/// Pareto front that follow it. If `most` is not in the front, the steps that are faster than the default
/// quality follow. Settings in `fixed` are the same in all steps. Adjacent steps that become equal are
/// merged. Adjacent steps whose settings for a part of the frame are equal get equal time ratios for that
/// part.
std::vector<FrontStep> front_for(const Presets& presets, const RunQuality& most, const FieldWords& fixed);

/// Returns the time of a monotonic clock, ms.
double steady_ms();

/// Chooses the quality for each part of each frame, so frames stay within the budget.
class RunBudget {
 public:
  /// @param front  quality settings, from accurate to fast; not empty; the run begins with the first
  /// @param budget_ms    time limit per frame
  /// @param has_picture  false: the run never renders images
  /// @param now_ms       clock, ms
  RunBudget(std::vector<FrontStep> front, double budget_ms, bool has_picture,
            std::function<double()> now_ms = steady_ms);

  /// Callback for SessionConfig::watch. Returns the new quality if it changes before this part of the frame.
  std::optional<RunQuality> before(FramePart part, const FrameLoad& load);
  /// Ends a frame; call after each frame. Returns the quality changes within the frame, in order, as events
  /// without a frame number.
  std::vector<ScriptEvent> end_frame();
  /// Returns a message for the user if the step has changed since the last message, at most once per second;
  /// otherwise an empty string.
  std::string news();
  /// Sets the radar's mode and resolution in all steps; call after the user has chosen them.
  void keep(const RadarConfig& radar);
  /// Returns the settings in which the current step differs from the run's first step, for example
  /// "depth_stride 2, shadows off". Empty if there are none.
  [[nodiscard]] std::string given_up() const;
  /// Returns the report's entry: the budget, the number of frames over it, the number of quality changes, and
  /// the number of frames that began with each setting.
  [[nodiscard]] nlohmann::json report() const;

 private:
  std::vector<FrontStep> front_;
  BudgetConfig config_;
  BudgetState state_;
  std::function<double()> now_ms_;
  /// Start times of the current frame's parts, and its end.
  std::array<double, kFrameParts + 1> begun_ms_{};
  /// Quality changes in the current frame.
  std::vector<ScriptEvent> changes_;
  /// Number of frames that began with each step.
  std::vector<std::int64_t> frames_at_;
  std::int64_t frames_ = 0, frames_over_ = 0, all_changes_ = 0;
  /// Step of the last message.
  std::size_t said_step_ = 0;
  /// Time of the last message.
  double said_ms_ = 0.0;
};

}  // namespace roomradar
