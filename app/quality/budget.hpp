// budget.hpp: holds the time of a frame by moving along a front of settings: which setting is the next frame,
// or the rest of this one, to be made with?
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/quality/frame_load.hpp"

namespace roomradar {

/// What a setting is to the controller.
struct BudgetStep {
  /// Times of its parts over those with the default quality; 0: such a part is not made in this run.
  std::array<double, kFrameParts> ratios{1.0, 1.0, 1.0, 1.0};
  bool alternates = false;      ///< no frame both moves the objects and makes a picture
  int move_every_n_frames = 1;  ///< of so many frames that move objects, an object is moved in one ...
  int objects = 0;              ///< ... and so many were there when the ratios were measured; 0: not known
};

struct BudgetConfig {
  double budget_ms = 33.0;  ///< that 95 of 100 frames are to keep
  double down_to = 0.95;    ///< part of the budget that a faster setting is chosen to take
  double back_below = 0.8;  ///< the next more accurate setting is taken when it would take less than this ...
  int patience_frames = 15;        ///< ... for so many frames on end,
  int most_patience_frames = 480;  ///< and where that turned out too early, twice as many, up to so many
  int regret_frames = 60;          ///< going back again within so many frames means that it was too early
  double attack = 0.7;             ///< part by which an estimate follows what took longer than expected
  double decay = 0.2;              ///< and what took less
};

/// What is remembered from frame to frame; times in ms.
struct BudgetState {
  std::vector<BudgetStep> front;  ///< from accurate to fast
  std::size_t settled = 0;        ///< step of the front that frames begin with
  std::size_t step = 0;           ///< of the part that is being made
  /// What each part takes at the first step, over what nominal_ms() says.
  std::array<double, kFrameParts> scales{1.0, 1.0, 1.0, 1.0};
  std::array<std::array<double, 3>, kFrameParts> lately{};  ///< the same of the last three frames
  std::array<int, kFrameParts> not_made_frames{};           ///< on end, in which a part took next to nothing
  /// What 95 of 100 frames stay below, over what was foreseen.
  double spread = 1.15;

  int calm_frames = 0;  ///< on end, in which the next more accurate step would have had time
  int patience_frames = 0;
  double strain = 0.0;  ///< frames that were cut on their way, of the last ten or so
  std::int64_t frame = 0;
  std::int64_t went_back_at = -1'000'000;  ///< frame of the last move to a more accurate step

  // Of the frame that is being made.
  std::array<std::size_t, kFrameParts> steps{};   ///< that each part began with
  std::array<double, kFrameParts> foreseen_ms{};  ///< of each part
  std::size_t begun = 0;                          ///< parts that have
  FrameLoad load;
};

/// A state that begins with a step of the front, which is not empty. Nothing is known of the machine yet, so
/// the first frames find it out.
BudgetState start_budget(std::vector<BudgetStep> front, const BudgetConfig& config, std::size_t step = 0);

/// The shape of the cost of a part by its load, for an accurate setting, ms on the machine it was measured
/// on: only how it grows matters, the rest is learned.
double nominal_ms(FramePart part, const FrameLoad& load);

/// Before a part begins: the step for it and what follows; state.step is set. Within a frame it goes to
/// faster steps only, and for that frame alone: the next begins where frames are settled, unless that happens
/// often.
/// @param elapsed_ms  since the frame began
/// @return the step, if it is another one than before
std::optional<std::size_t> decide(BudgetState& state, const BudgetConfig& config, FramePart part,
                                  const FrameLoad& load, double elapsed_ms);

/// After a frame: learns from the times of its parts. One that took next to none of what was foreseen was not
/// made, and says nothing; if it goes on so, what was foreseen is too much, and is forgotten.
void learn(BudgetState& state, const BudgetConfig& config, const std::array<double, kFrameParts>& parts_ms);

/// What a whole frame of this load is expected to take at a step, at the most in 95 of 100.
double foreseen_ms(const BudgetState& state, std::size_t step, const FrameLoad& load);

}  // namespace roomradar
