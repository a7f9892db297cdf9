// timing_pane.hpp: chart of the time of each stage over the last frames, with the budget.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

inline constexpr double kGoal_ms = 16.6;  ///< period of frames at 60 Hz

class TimingPane {
 public:
  /// @param budget_ms  the run's time limit per frame; unset: 33.3, the period of a Kinect's frames
  explicit TimingPane(std::optional<double> budget_ms) : budget_ms_(budget_ms.value_or(33.3)) {}

  void add(const Snapshot& shown);
  void draw(const Area& area, const look::Fonts& fonts) const;

  [[nodiscard]] double budget_ms() const { return budget_ms_; }
  /// Time limit that the chart marks, ms.
  [[nodiscard]] double goal_ms() const { return std::min(kGoal_ms, budget_ms_); }
  /// Returns the processing time of the last frame, excluding the time to read it from the source.
  [[nodiscard]] float frame_ms() const { return frames_.empty() ? 0.0F : frames_.back().whole_ms; }

  /// Stages from bottom to top of the chart. "rest" is the time outside all other stages.
  static constexpr std::array<const char*, 10> kStages = {
      "locate", "expected", "foreground", "changes", "mesh", "physics", "radar", "light", "compose", "rest"};

 private:
  struct Times {
    std::array<float, kStages.size()> stages_ms{};
    float whole_ms = 0.0F;
    float read_ms = 0.0F;
  };
  /// Draws each stage's colour and median time.
  void draw_legend(const Area& area, float median_ms, const look::Fonts& fonts) const;

  static constexpr std::size_t kKept = 240;
  double budget_ms_;
  std::vector<Times> frames_;  ///< oldest first
};

}  // namespace roomradar
