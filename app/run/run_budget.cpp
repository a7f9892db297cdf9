// run_budget.cpp: converts the controller's steps to qualities, events and messages.
#include "app/run/run_budget.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>
#include <utility>

#include "app/quality/quality_json.hpp"

namespace roomradar {
namespace {

std::vector<BudgetStep> steps_of(const std::vector<FrontStep>& front, bool has_picture) {
  std::vector<BudgetStep> steps;
  for (const FrontStep& step : front) {
    const bool alternates = has_picture && step.run.picture_every_n_frames > 1;
    const int turns =
        alternates ? std::max(step.run.move_every_n_frames / 2, 1) : step.run.move_every_n_frames;
    steps.push_back({step.part_ratios, alternates, turns, step.objects});
    if (!has_picture) steps.back().ratios[index_of(FramePart::kCompose)] = 0.0;
  }
  return steps;
}

/// Returns true if both qualities do this part's work in the same way.
bool is_alike(FramePart part, const RunQuality& a, const RunQuality& b) {
  const auto of_mesh = [](const RunQuality& q) {
    return std::tie(q.depth_stride, q.mesh_tolerance_sigmas, q.fine_mesh);
  };
  const auto of_physics = [](const RunQuality& q) {
    return std::tuple(q.radar, q.radar_px, q.move_every_n_frames, q.physics_step_s,
                      q.picture_every_n_frames > 1);
  };
  const auto of_compose = [](const RunQuality& q) {
    return std::tie(q.object_error_px, q.soft_edges, q.bridge_gaps, q.shadows, q.shadow_every_n_frames);
  };
  switch (part) {
    case FramePart::kLocate:
      return a.depth_stride == b.depth_stride && a.tracking_px == b.tracking_px &&
             a.verify_every_n_frames == b.verify_every_n_frames;
    case FramePart::kMesh:
      return of_mesh(a) == of_mesh(b);
    case FramePart::kPhysics:  // its cost depends on the mesh
      return of_mesh(a) == of_mesh(b) && of_physics(a) == of_physics(b);
    case FramePart::kCompose:
      return of_compose(a) == of_compose(b);
    case FramePart::kDone:
      break;
  }
  return true;
}

/// Makes the time ratios of a part equal in adjacent steps that do it in the same way. Measured differences
/// are noise there, or come from a setting that is fixed now.
void give_alike_parts_one_ratio(std::vector<FrontStep>& front) {
  for (std::size_t step = 1; step < front.size(); ++step)
    for (std::size_t part = 0; part < kFrameParts; ++part)
      if (is_alike(static_cast<FramePart>(part), front[step - 1].run, front[step].run))
        front[step].part_ratios[part] = front[step - 1].part_ratios[part];
}

/// Returns the approximate time of a typical frame relative to the default quality.
double part_of_usual(const FrontStep& step) {
  constexpr FrameLoad kSome{.dynamic_fraction = 0.1, .moving = 2, .resting = 2};
  double ms = 0.0, default_ms = 0.0;
  for (std::size_t part = 0; part < kFrameParts; ++part) {
    const double part_ms = nominal_ms(static_cast<FramePart>(part), kSome);
    ms += step.part_ratios[part] * part_ms;
    default_ms += part_ms;
  }
  return ms / default_ms;
}

}  // namespace

std::vector<FrontStep> front_for(const Presets& presets, const RunQuality& most, const FieldWords& fixed) {
  std::vector<FrontStep> front(1);
  front.front().run = most;
  bool is_in_front = false;
  for (FrontStep step : presets.front) {
    set_fields(step.run, fixed);
    if (step.run == most) {
      if (!is_in_front) front = {std::move(step)};  // drops steps more accurate than requested
      is_in_front = true;
    } else if (!(step.run == front.back().run)) {
      front.push_back(std::move(step));
    }
  }
  if (!is_in_front)  // drops steps slower than requested, too
    front.erase(std::remove_if(front.begin() + 1, front.end(),
                               [](const FrontStep& step) { return !(part_of_usual(step) < 1.0); }),
                front.end());
  give_alike_parts_one_ratio(front);
  return front;
}

double steady_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}

RunBudget::RunBudget(std::vector<FrontStep> front, double budget_ms, bool has_picture,
                     std::function<double()> now_ms)
    : front_(std::move(front)), now_ms_(std::move(now_ms)), frames_at_(front_.size(), 0) {
  config_.budget_ms = budget_ms;
  state_ = start_budget(steps_of(front_, has_picture), config_);
}

std::optional<RunQuality> RunBudget::before(FramePart part, const FrameLoad& load) {
  const std::size_t number = index_of(part);
  begun_ms_[number] = now_ms_();
  if (part == FramePart::kDone) return std::nullopt;
  const auto changed = decide(state_, config_, part, load, begun_ms_[number] - begun_ms_[0]);
  if (!changed) return std::nullopt;
  ++all_changes_;
  const RunQuality& quality = front_[*changed].run;
  changes_.push_back({SetQuality{quality, part}});
  return quality;
}

std::vector<ScriptEvent> RunBudget::end_frame() {
  if (state_.begun == 0) return {};  // frame not processed
  const double frame_ms = begun_ms_[index_of(FramePart::kDone)] - begun_ms_[0];
  begun_ms_[state_.begun] = begun_ms_[index_of(FramePart::kDone)];
  std::array<double, kFrameParts> parts_ms{};
  for (std::size_t part = 0; part < state_.begun; ++part)
    parts_ms[part] = begun_ms_[part + 1] - begun_ms_[part];
  ++frames_;
  if (frame_ms > config_.budget_ms) ++frames_over_;
  ++frames_at_[state_.steps[0]];
  learn(state_, config_, parts_ms);
  return std::exchange(changes_, {});
}

std::string RunBudget::given_up() const {
  std::string list;
  for (const auto& [name, word] : words_of(front_[state_.step].run, front_.front().run))
    list.append(list.empty() ? "" : ", ").append(name).append(" ").append(word);
  return list;
}

void RunBudget::keep(const RadarConfig& radar) {
  for (FrontStep& step : front_) {
    step.run.radar = radar.mode;
    step.run.radar_px = radar.resolution_px;
  }
}

std::string RunBudget::news() {
  constexpr double kSay_ms = 1000.0;
  const double now_ms = now_ms_();
  if (said_step_ == state_.step || now_ms < said_ms_ + kSay_ms) return {};
  said_step_ = state_.step;
  said_ms_ = now_ms;
  const std::string budget = "budget " + std::to_string(std::lround(config_.budget_ms)) + " ms: ";
  return budget + (state_.step == 0 ? "with the requested quality" : "with " + given_up());
}

nlohmann::json RunBudget::report() const {
  nlohmann::json settings = nlohmann::json::array();
  for (std::size_t step = 0; step < front_.size(); ++step)
    if (frames_at_[step] > 0)
      settings.push_back({{"step", step}, {"frames", frames_at_[step]}, {"run", to_json(front_[step].run)}});
  return {{"budget_ms", config_.budget_ms}, {"frames", frames_},      {"frames_over", frames_over_},
          {"changes", all_changes_},        {"steps", front_.size()}, {"settings", settings}};
}

}  // namespace roomradar
