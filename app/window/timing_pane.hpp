// timing_pane.hpp: how long each stage of the last frames took, against the budget.
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "app/window/look.hpp"
#include "app/window/play_link.hpp"
#include "app/window/window_layout.hpp"

namespace roomradar {

inline constexpr double kBudget_ms = 33.3;  ///< of a frame at the Kinect's rate
inline constexpr double kGoal_ms = 16.6;    ///< of a frame at 60 Hz

class TimingPane {
 public:
  void add(const Snapshot& shown);
  void draw(const Area& area, const look::Fonts& fonts) const;

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
  std::vector<Times> frames_;  ///< oldest first
};

}  // namespace roomradar
