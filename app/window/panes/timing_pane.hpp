// timing_pane.hpp: how long each stage of the last frames took, against the budget.
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

inline constexpr double kGoal_ms = 16.6;  ///< of a frame at 60 Hz

class TimingPane {
 public:
  /// @param budget_ms  what is held to; none: of a frame at the Kinect's rate
  explicit TimingPane(std::optional<double> budget_ms) : budget_ms_(budget_ms.value_or(33.3)) {}

  void add(const Snapshot& shown);
  void draw(const Area& area, const look::Fonts& fonts) const;

  [[nodiscard]] double budget_ms() const { return budget_ms_; }
  /// No more than the budget.
  [[nodiscard]] double goal_ms() const { return std::min(kGoal_ms, budget_ms_); }
  /// Of the last frame, all but reading it.
  [[nodiscard]] float frame_ms() const { return frames_.empty() ? 0.0F : frames_.back().whole_ms; }

  /// In the order in which they are stacked; the last is what is in none of them.
  static constexpr std::array<const char*, 9> kStages = {
      "locate", "expected", "foreground", "changes", "mesh", "physics", "radar", "compose", "rest"};

 private:
  struct Times {
    std::array<float, kStages.size()> stages_ms{};
    float whole_ms = 0.0F;
    float read_ms = 0.0F;
  };
  static constexpr std::size_t kKept = 240;
  double budget_ms_;
  std::vector<Times> frames_;  ///< oldest first
};

}  // namespace roomradar
