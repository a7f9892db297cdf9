// run_budget.hpp: keeps frames within a time budget by switching between quality settings of a Pareto front.
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

/// Returns the quality settings that a run may use, each called a step. The first step is `most`. If `most`
/// is in the presets' Pareto front, the steps after it in the front follow. Otherwise the front's steps that
/// are faster than the default quality follow. Settings in `fixed` are the same in all steps. Adjacent steps
/// that thus become equal are merged. Adjacent steps with equal settings for a part of the frame get equal
/// time ratios for that part.
std::vector<FrontStep> front_for(const Presets& presets, const RunQuality& most, const FieldWords& fixed);

/// Returns the time of a monotonic clock, ms.
double steady_ms();

/// Chooses the quality for each part of each frame so that frames stay within the budget.
class RunBudget {
 public:
  /// @param front  quality settings, from accurate to fast. Not empty. The first is used at the start
  /// @param budget_ms    time limit per frame
  /// @param has_picture  false: the run never renders images
  /// @param now_ms       returns the current time, ms
  RunBudget(std::vector<FrontStep> front, double budget_ms, bool has_picture,
            std::function<double()> now_ms = steady_ms);

  /// Callback for SessionConfig::watch. Returns the quality for `part`, which begins now; nullopt if the
  /// quality does not change.
  std::optional<RunQuality> before(FramePart part, const FrameLoad& load);
  /// Call after each frame. Returns the frame's quality changes, in order, as script events without a frame
  /// number.
  std::vector<ScriptEvent> end_frame();
  /// Returns a message for the user if the step has changed since the last message. Otherwise, and within 1 s
  /// after a message, returns an empty string.
  std::string news();
  /// Sets the radar's mode and resolution in all steps. Call after the user has changed them.
  void keep(const RadarConfig& radar);
  /// Returns the settings in which the current step differs from the run's first step, such as "depth_stride
  /// 2, shadows off".
  [[nodiscard]] std::string given_up() const;
  /// Returns the report's entry. It contains the budget, the number of frames above it, the number of quality
  /// changes, and the number of frames that began with each step.
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
