// run_budget.hpp: a run that keeps to a time: its front of qualities, what they were used for, and what it
// says.
#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/quality/budget.hpp"
#include "app/quality/presets.hpp"
#include "app/session/script.hpp"

namespace roomradar {

/// The steps that a run may take: `most`, and of the presets' front what comes after that, or all that is
/// faster than the default if it is not in the front. What is fixed by name is so in all of them; neighbours
/// that become alike are one, and parts that neighbours make alike take the same in both.
std::vector<FrontStep> front_for(const Presets& presets, const RunQuality& most, const FieldWords& fixed);

/// Of the wall clock.
double steady_ms();

class RunBudget {
 public:
  /// @param front        not empty; the first step is what the run begins with
  /// @param has_picture  whether pictures are made at all
  /// @param now_ms       a clock
  RunBudget(std::vector<FrontStep> front, double budget_ms, bool has_picture,
            std::function<double()> now_ms = steady_ms);

  /// For SessionConfig::watch.
  std::optional<RunQuality> before(FramePart part, const FrameLoad& load);
  /// After the frame. Its changes of quality are events without a frame, in their order.
  std::vector<ScriptEvent> end_frame();
  /// A sentence for the user, if something changed that was not said yet, once a second at most.
  std::string news();
  /// From now on every step has this radar: it was asked for.
  void keep(const RadarConfig& radar);
  /// What is given up now of what the run began with, "depth_stride 2, shadows off"; empty: nothing.
  [[nodiscard]] std::string given_up() const;
  /// Budget, frames over it, changes, and the frames that were begun with each setting.
  [[nodiscard]] nlohmann::json report() const;

 private:
  std::vector<FrontStep> front_;
  BudgetConfig config_;
  BudgetState state_;
  std::function<double()> now_ms_;
  std::array<double, kFrameParts + 1> begun_ms_{};  ///< parts of this frame
  std::vector<ScriptEvent> changes_;                ///< of this frame
  std::vector<std::int64_t> frames_at_;             ///< of each step
  std::int64_t frames_ = 0, frames_over_ = 0, all_changes_ = 0;
  std::size_t said_step_ = 0;
  double said_ms_ = 0.0;
};

}  // namespace roomradar
