// budget.hpp: keeps frames within a time budget by choosing among the quality settings (steps) of a Pareto
// front.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/quality/frame_load.hpp"

namespace roomradar {

/// Data that the budget controller needs of a quality setting.
struct BudgetStep {
  /// Time of each FramePart divided by its time at the default quality; 0: the run omits the part.
  std::array<double, kFrameParts> ratios{1.0, 1.0, 1.0, 1.0};
  bool alternates = false;      ///< true: frames advance objects or make a picture, not both
  int move_every_n_frames = 1;  ///< each object is advanced in every n-th frame that advances objects
  int objects = 0;              ///< number of objects in the measurement of `ratios`; 0: unknown
};

struct BudgetConfig {
  double budget_ms = 33.0;  ///< time limit that 95 % of the frames must meet
  /// A downgrade selects a step with a predicted time of at most this fraction of the budget.
  double down_to = 0.95;
  double back_below = 0.8;         ///< an upgrade requires a predicted time below this fraction of the budget
  int patience_frames = 15;        ///< number of consecutive frames that must permit an upgrade
  int most_patience_frames = 480;  ///< max of patience_frames, doubled by each premature upgrade
  int regret_frames = 60;          ///< an upgrade is premature if it is undone within this many frames
  double attack = 0.7;             ///< filter gain for parts slower than predicted
  double decay = 0.2;              ///< filter gain for parts faster than predicted
};

/// State of the controller. Times are in ms.
struct BudgetState {
  std::vector<BudgetStep> front;  ///< steps, from accurate to fast
  std::size_t settled = 0;        ///< index in `front` of the step with which frames begin
  std::size_t step = 0;           ///< index in `front` of the current part's step
  /// Per part: estimated time at the default quality divided by nominal_ms().
  std::array<double, kFrameParts> scales{1.0, 1.0, 1.0, 1.0};
  std::array<std::array<double, 3>, kFrameParts> lately{};  ///< `scales` of the last three frames
  /// Per part: number of consecutive frames that skipped the part.
  std::array<int, kFrameParts> not_made_frames{};
  /// Estimated 95th percentile of measured time divided by predicted time.
  double spread = 1.15;

  /// Number of consecutive frames in which a more accurate step would have met the budget.
  int calm_frames = 0;
  int patience_frames = 0;
  /// Number of switches to a faster step within a frame. Decays by 10 % per frame.
  double strain = 0.0;
  std::int64_t frame = 0;
  std::int64_t went_back_at = -1'000'000;  ///< frame of the last upgrade

  // State of the current frame:
  std::array<std::size_t, kFrameParts> steps{};   ///< step with which each part began
  std::array<double, kFrameParts> foreseen_ms{};  ///< predicted time per part
  std::size_t begun = 0;                          ///< number of parts begun
  FrameLoad load;
};

/// Returns the initial state. The speed of the machine is estimated from the first frames.
/// @param front must not be empty
/// @param step index in `front` of the step for the first frame
BudgetState start_budget(std::vector<BudgetStep> front, const BudgetConfig& config, std::size_t step = 0);

/// Returns the time of a part at the default quality on a reference machine, ms. Only its dependence on the
/// load matters; BudgetState::scales adapts it to the current machine.
double nominal_ms(FramePart part, const FrameLoad& load);

/// Chooses the step (quality setting) for `part` and all later parts of the frame, and sets state.step. Call
/// before the part begins. Within a frame, the step only becomes faster. The next frame begins with
/// state.settled. If two frames within about ten switch to faster steps, state.settled becomes faster, too.
/// @param elapsed_ms  time since the frame began
/// @return index of the new step; unset if the step did not change
std::optional<std::size_t> decide(BudgetState& state, const BudgetConfig& config, FramePart part,
                                  const FrameLoad& load, double elapsed_ms);

/// Updates the estimates from the measured times of a frame's parts. A part that takes at most 2 % of its
/// prediction counts as skipped and is ignored. If a part is skipped in more than 17 consecutive frames and
/// its entry of `scales` exceeds 1, that entry decays to 1.
void learn(BudgetState& state, const BudgetConfig& config, const std::array<double, kFrameParts>& parts_ms);

/// Returns the predicted 95th percentile of the time of a whole frame with this load at a step, ms.
double foreseen_ms(const BudgetState& state, std::size_t step, const FrameLoad& load);

}  // namespace roomradar
