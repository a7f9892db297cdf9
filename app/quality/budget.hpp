// budget.hpp: keeps frames within a time budget by choosing settings (steps) on a Pareto front.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/quality/frame_load.hpp"

namespace roomradar {

/// Data of a setting that the controller needs.
struct BudgetStep {
  /// Time of each part relative to the default quality; 0: runs never do this part.
  std::array<double, kFrameParts> ratios{1.0, 1.0, 1.0, 1.0};
  bool alternates = false;      ///< true: no frame both moves objects and makes a picture
  int move_every_n_frames = 1;  ///< an object is moved in every n-th frame that moves objects
  int objects = 0;              ///< number of objects when the ratios were measured; 0: unknown
};

struct BudgetConfig {
  double budget_ms = 33.0;   ///< time limit for 95% of the frames
  double down_to = 0.95;     ///< downgrade to a setting predicted to take at most this fraction of the budget
  double back_below = 0.8;   ///< upgrade to a setting predicted to take less than this fraction of the budget
  int patience_frames = 15;  ///< consecutive frames that must allow an upgrade first
  int most_patience_frames = 480;  ///< patience doubles after each premature upgrade, up to this
  int regret_frames = 60;          ///< an upgrade undone within this many frames was premature
  double attack = 0.7;             ///< gain of the filter for parts slower than predicted
  double decay = 0.2;              ///< gain of the filter for parts faster than predicted
};

/// The controller's state from frame to frame; times in ms.
struct BudgetState {
  std::vector<BudgetStep> front;  ///< settings, from accurate to fast
  std::size_t settled = 0;        ///< index in front of the step with which frames begin
  std::size_t step = 0;           ///< index in front of the current part's step
  /// Per part: estimated time at the default quality / nominal_ms().
  std::array<double, kFrameParts> scales{1.0, 1.0, 1.0, 1.0};
  std::array<std::array<double, 3>, kFrameParts> lately{};  ///< scales of the last three frames
  std::array<int, kFrameParts> not_made_frames{};  ///< per part: consecutive frames with almost no time
  /// Estimated p95 of the ratio: time taken / time predicted.
  double spread = 1.15;

  int calm_frames = 0;  ///< consecutive frames in which a more accurate step would have fitted
  int patience_frames = 0;
  double strain = 0.0;  ///< running count of frames switched to a faster step midway, over about ten frames
  std::int64_t frame = 0;
  std::int64_t went_back_at = -1'000'000;  ///< frame of the last upgrade

  // Of the current frame:
  std::array<std::size_t, kFrameParts> steps{};   ///< step with which each part began
  std::array<double, kFrameParts> foreseen_ms{};  ///< predicted time per part
  std::size_t begun = 0;                          ///< number of parts begun
  FrameLoad load;
};

/// Returns a state that begins with a step of `front`, which must not be empty. The machine's speed is
/// learned from the first frames.
BudgetState start_budget(std::vector<BudgetStep> front, const BudgetConfig& config, std::size_t step = 0);

/// Returns the typical time of a part at an accurate setting, ms, on the machine where it was measured. Only
/// its growth with the load matters; BudgetState::scales adapts it to this machine.
double nominal_ms(FramePart part, const FrameLoad& load);

/// Chooses the step for a part and those after it, before the part begins; sets state.step. Within a frame,
/// the step only becomes faster, and only for this frame. The next frame begins at state.settled, which
/// becomes faster too if this happens often.
/// @param elapsed_ms  since the frame began
/// @return the step, if it changed
std::optional<std::size_t> decide(BudgetState& state, const BudgetConfig& config, FramePart part,
                                  const FrameLoad& load, double elapsed_ms);

/// Updates the estimates from the times of a frame's parts. Parts far below prediction count as skipped and
/// are ignored; if this persists, the prediction is reset.
void learn(BudgetState& state, const BudgetConfig& config, const std::array<double, kFrameParts>& parts_ms);

/// Returns the predicted p95 of the time of a whole frame of this load at a step.
double foreseen_ms(const BudgetState& state, std::size_t step, const FrameLoad& load);

}  // namespace roomradar
