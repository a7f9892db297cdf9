// budget.cpp: predicts the time of a frame's parts from recent frames, and chooses a setting that fits.
#include "app/quality/budget.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace roomradar {
namespace {

constexpr double kMostSpread = 2.0;
constexpr double kQuantile = 0.95, kQuantileStep = 0.02;
constexpr std::int64_t kLongAgo = -1'000'000;
constexpr double kNotMade = 0.02;
constexpr int kMostNotMade_frames = 17;                 // more than the longest cycle of pictures and objects
constexpr double kMostStrain = 1.5, kStrainKept = 0.9;  // exceeded by two interrupted frames within about ten

/// Returns the fraction of the objects in the room that a frame moves, if it moves any.
double moved_share(int objects, int turns) { return std::max(1.0 / std::max(objects, 1), 1.0 / turns); }

/// Returns the measured ratio, corrected for the number of objects: with few objects and many turns, a frame
/// moves a larger fraction of them.
double part_ratio(const BudgetStep& step, std::size_t part, const FrameLoad& load) {
  const double measured = step.ratios[part];
  if (part != index_of(FramePart::kPhysics) || step.objects == 0) return measured;
  return measured * moved_share(load.moving + load.resting, step.move_every_n_frames) /
         moved_share(step.objects, step.move_every_n_frames);
}

double part_ms(const BudgetState& state, std::size_t step, std::size_t part, const FrameLoad& load) {
  return state.scales[part] * part_ratio(state.front[step], part, load) *
         nominal_ms(static_cast<FramePart>(part), load);
}

/// Returns the predicted p95 of the time from a part to the end of the frame.
double rest_ms(const BudgetState& state, std::size_t step, std::size_t part, const FrameLoad& load) {
  std::array<double, kFrameParts> ms{};
  for (; part < kFrameParts; ++part) ms[part] = part_ms(state, step, part, load);
  double& physics_ms = ms[index_of(FramePart::kPhysics)];
  double& compose_ms = ms[index_of(FramePart::kCompose)];
  if (state.front[step].alternates) (physics_ms < compose_ms ? physics_ms : compose_ms) = 0.0;
  return state.spread * std::accumulate(ms.begin(), ms.end(), 0.0);
}

/// Returns the most accurate step, starting at `from`, in which the rest of the frame fits; if none fits, the
/// fastest.
std::size_t step_in_time(const BudgetState& state, const BudgetConfig& config, std::size_t from,
                         std::size_t first_part, const FrameLoad& load, double elapsed_ms) {
  std::size_t best = from;
  double best_ms = elapsed_ms + rest_ms(state, from, first_part, load);
  for (std::size_t step = from + 1; step < state.front.size(); ++step) {
    const double ms = elapsed_ms + rest_ms(state, step, first_part, load);
    if (ms < best_ms) {
      best = step;
      best_ms = ms;
    }
    if (ms <= config.down_to * config.budget_ms) break;
  }
  return best;
}

/// Returns true if a frame at this step leaves enough of the budget for an upgrade to it.
bool has_time(const BudgetState& state, const BudgetConfig& config, std::size_t step, const FrameLoad& load) {
  return rest_ms(state, step, 0, load) < config.back_below * config.budget_ms;
}

/// Returns the most accurate step that fits, among those before the settled one; the settled one if none
/// fits. It may be several steps away, because a step may gain time in one part and lose time in another.
std::size_t most_accurate_in_time(const BudgetState& state, const BudgetConfig& config,
                                  const FrameLoad& load) {
  std::size_t step = 0;
  while (step < state.settled && !has_time(state, config, step, load)) ++step;
  return step;
}

/// Returns the step half way to `with_time`, or closer to it if the steps there do not fit. Only half way,
/// because predictions may be wrong.
std::size_t half_way_back(const BudgetState& state, const BudgetConfig& config, std::size_t with_time,
                          const FrameLoad& load) {
  std::size_t step = state.settled - (state.settled - with_time + 1) / 2;
  while (step > with_time && !has_time(state, config, step, load)) --step;
  return step;
}

/// Chooses the step with which the following frames begin.
void adapt(BudgetState& state, const BudgetConfig& config, const FrameLoad& load) {
  const std::size_t before = state.settled;
  const std::size_t with_time = most_accurate_in_time(state, config, load);
  state.calm_frames = with_time < before ? state.calm_frames + 1 : 0;
  if (rest_ms(state, before, 0, load) > config.budget_ms) {
    state.settled = with_time < before ? half_way_back(state, config, with_time, load)
                                       : step_in_time(state, config, before, 0, load, 0.0);
  } else if (state.strain > kMostStrain) {  // predicted to fit, but frames did not
    state.settled = std::min(before + 1, state.front.size() - 1);
  } else if (state.calm_frames >= state.patience_frames) {
    state.settled = half_way_back(state, config, with_time, load);
    state.calm_frames = 0;
    state.went_back_at = state.frame;
  }
  if (state.settled > before) {
    state.calm_frames = 0;
    state.strain = 0.0;
    if (state.frame - state.went_back_at < config.regret_frames) {
      state.patience_frames = std::min(2 * state.patience_frames, config.most_patience_frames);
      state.went_back_at = kLongAgo;  // counts as premature only once
    }
  }
  if (state.frame - state.went_back_at == 2 * config.regret_frames)
    state.patience_frames = std::max(state.patience_frames / 2, config.patience_frames);
  state.strain *= kStrainKept;
}

double median_of(std::array<double, 3> values) {
  std::sort(values.begin(), values.end());
  return values[1];
}

}  // namespace

double nominal_ms(FramePart part, const FrameLoad& load) {
  // Estimates for 640 x 480 and teapots: a dynamic fifth of the image costs 2 ms, a moving object 0.2 ms, a
  // resting one 0.05 ms, and drawing an object 0.1 ms.
  switch (part) {
    case FramePart::kLocate:
      return 6.0;
    case FramePart::kMesh:
      return 0.3 + 10.0 * load.dynamic_fraction;
    case FramePart::kPhysics:
      return 0.1 + 0.2 * load.moving + 0.05 * load.resting;
    case FramePart::kCompose:
      return 2.0 + 0.1 * (load.moving + load.resting);
    case FramePart::kDone:
      break;
  }
  return 0.0;
}

BudgetState start_budget(std::vector<BudgetStep> front, const BudgetConfig& config, std::size_t step) {
  BudgetState state;
  for (std::array<double, 3>& lately : state.lately) lately.fill(1.0);
  state.front = std::move(front);
  state.settled = state.step = step;
  state.patience_frames = config.patience_frames;
  return state;
}

double foreseen_ms(const BudgetState& state, std::size_t step, const FrameLoad& load) {
  return rest_ms(state, step, 0, load);
}

std::optional<std::size_t> decide(BudgetState& state, const BudgetConfig& config, FramePart part,
                                  const FrameLoad& load, double elapsed_ms) {
  const std::size_t before = state.step, first = index_of(part);
  if (part == FramePart::kLocate) {
    adapt(state, config, load);
    state.step = state.settled;
  } else if (elapsed_ms + rest_ms(state, state.step, first, load) > config.budget_ms) {
    state.step = step_in_time(state, config, state.step, first, load, elapsed_ms);
    state.calm_frames = 0;
    if (state.step != before) state.strain += 1.0;
  }
  state.steps[first] = state.step;
  state.foreseen_ms[first] = part_ms(state, state.step, first, load);
  state.load = load;
  state.begun = first + 1;
  return state.step == before ? std::nullopt : std::optional(state.step);
}

void learn(BudgetState& state, const BudgetConfig& config, const std::array<double, kFrameParts>& parts_ms) {
  double took_ms = 0.0, foreseen = 0.0;
  for (std::size_t part = 0; part < state.begun; ++part) {
    if (!(state.foreseen_ms[part] > 0.0)) continue;
    if (!(parts_ms[part] > kNotMade * state.foreseen_ms[part])) {
      if (++state.not_made_frames[part] > kMostNotMade_frames && state.scales[part] > 1.0)
        state.scales[part] += config.decay * (1.0 - state.scales[part]);
      continue;
    }
    state.not_made_frames[part] = 0;
    took_ms += parts_ms[part];
    foreseen += state.foreseen_ms[part];
    // The mesh uses the depth image of the frame's first step, so its time is not that of this step.
    const bool is_mixed = part == index_of(FramePart::kMesh) && state.steps[part] != state.steps[0];
    if (is_mixed) continue;
    const double at_one_ms = state.foreseen_ms[part] / state.scales[part];
    std::array<double, 3>& lately = state.lately[part];
    lately = {parts_ms[part] / at_one_ms, lately[0], lately[1]};
    const double scale = median_of(lately);  // ignores a single outlier
    state.scales[part] +=
        (scale > state.scales[part] ? config.attack : config.decay) * (scale - state.scales[part]);
  }
  if (foreseen > 0.0) {
    const bool is_above = took_ms > state.spread * foreseen;
    state.spread += kQuantileStep * (is_above ? kQuantile : kQuantile - 1.0);
    state.spread = std::clamp(state.spread, 1.0, kMostSpread);
  }
  state.begun = 0;
  ++state.frame;
}

}  // namespace roomradar
