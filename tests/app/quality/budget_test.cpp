// budget_test.cpp: the frame-time controller on simulated machines: loads, noise, outliers.
#include "app/quality/budget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "app/run/run_budget.hpp"

namespace roomradar::budget_test {
namespace {

/// Each step takes 0.8 times as long as the previous one; parts of the frame gain differently.
std::vector<BudgetStep> steps(std::size_t count) {
  std::vector<BudgetStep> front(count);
  double ratio = 1.0;
  for (BudgetStep& step : front) {
    step.ratios = {0.3 + 0.7 * ratio, ratio, ratio, 0.5 + 0.5 * ratio};
    ratio *= 0.8;
  }
  return front;
}

constexpr FrameLoad kCalm{};
constexpr FrameLoad kCrowd{.dynamic_fraction = 0.5, .moving = 50, .resting = 0};

/// A simulated machine that determines frame times.
struct Machine {
  double speed = 1.0;  ///< factor on nominal_ms() for all parts
  double noise = 0.0;  ///< relative variation of frame times, +-
  double wrong = 0.0;  ///< fraction of each step's predicted gain that is not achieved
  std::mt19937 random{1};
  BudgetConfig config;
  BudgetState state;

  explicit Machine(std::size_t count = 8) : state(start_budget(steps(count), {})) {}

  /// Runs one frame and returns its time. Before kMesh, the known load is that of the previous frame.
  double frame(const FrameLoad& load, double longer = 1.0) {
    std::uniform_real_distribution<double> part(-noise, noise);
    const double factor = speed * longer * (1.0 + part(random));
    double elapsed_ms = 0.0;
    std::array<double, kFrameParts> parts_ms{};
    FrameLoad known = load;
    known.dynamic_fraction = moved_before_;
    for (std::size_t i = 0; i < kFrameParts; ++i) {
      const auto which = static_cast<FramePart>(i);
      if (which == FramePart::kMesh) known = load;
      changes += decide(state, config, which, known, elapsed_ms) ? 1 : 0;
      const double ratio = state.front[state.step].ratios[i];
      parts_ms[i] = factor * nominal_ms(which, load) * (ratio + (1.0 - ratio) * wrong);
      elapsed_ms += parts_ms[i];
    }
    learn(state, config, parts_ms);
    moved_before_ = load.dynamic_fraction;
    return elapsed_ms;
  }

  void run(int frames, const FrameLoad& load, std::vector<double>* took_ms = nullptr) {
    for (int i = 0; i < frames; ++i) {
      const double ms = frame(load);
      if (took_ms != nullptr) took_ms->push_back(ms);
    }
  }
  int changes = 0;

 private:
  double moved_before_ = 0.0;
};

double p95(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  return ms[static_cast<std::size_t>(0.95 * static_cast<double>(ms.size() - 1))];
}

TEST(Budget, SuddenLoadIsHeldAndAllComesBackAfterIt) {
  for (const double noise : {0.0, 0.1, 0.25}) {
    Machine machine;
    machine.noise = noise;
    machine.config.budget_ms = 16.0;
    ASSERT_GT(nominal_ms(FramePart::kPhysics, kCrowd) + nominal_ms(FramePart::kMesh, kCrowd), 14.0)
        << "the load alone would fill the budget";
    std::vector<double> took_ms, loaded_ms;
    machine.run(250, kCalm, &took_ms);
    EXPECT_EQ(machine.state.step, 0U);
    machine.run(500, kCrowd, &loaded_ms);
    EXPECT_GT(machine.state.step, 0U);
    took_ms.insert(took_ms.end(), loaded_ms.begin(), loaded_ms.end());
    machine.run(250, kCalm, &took_ms);
    EXPECT_EQ(machine.state.step, 0U);
    EXPECT_LE(p95(took_ms), machine.config.budget_ms) << "noise " << noise;
    EXPECT_LE(p95(loaded_ms), 1.02 * machine.config.budget_ms) << "noise " << noise;
  }
}

TEST(Budget, ThePersonIsSeenBeforeSheIsMeshed) {
  Machine machine;
  machine.config.budget_ms = 12.0;
  machine.run(50, kCalm);
  // Reacts in the very frame in which half of the image moves.
  const double ms = machine.frame({.dynamic_fraction = 0.5});
  EXPECT_LE(ms, machine.config.budget_ms);
  EXPECT_GT(machine.state.step, 0U);
}

TEST(Budget, NothingIsGivenUpWhereThereIsTime) {
  Machine machine;
  machine.noise = 0.2;
  machine.config.budget_ms = 33.0;
  machine.run(1000, kCalm);
  EXPECT_EQ(machine.changes, 0);
}

TEST(Budget, NoMoreIsGivenUpThanNeeded) {
  Machine machine;
  machine.config.budget_ms = 16.0;
  machine.run(300, kCrowd);
  const std::size_t step = machine.state.step;
  ASSERT_GT(step, 0U);
  // Of the previous steps, the next one would leave no room for noise, and the one before it would exceed the
  // budget.
  std::vector<double> more_accurate_ms;
  Machine other;
  other.config.budget_ms = 1e6;
  other.state.settled = step - 1;
  other.config.patience_frames = 1'000'000;
  other.state.patience_frames = 1'000'000;
  EXPECT_GT(other.frame(kCrowd), machine.config.back_below * machine.config.budget_ms / 1.2);
}

TEST(Budget, BetweenTwoSettingsItDoesNotSwing) {
  // The ratios predict that the more accurate setting fits, but it does not.
  Machine machine;
  machine.wrong = 0.6;
  machine.noise = 0.1;
  machine.config.budget_ms = 14.0;
  machine.run(500, kCrowd);
  machine.changes = 0;
  machine.run(3000, kCrowd);
  EXPECT_LE(machine.changes, 40) << "some twice in 150 frames at the most";
}

TEST(Budget, AccidentsPass) {
  Machine machine;
  machine.config.budget_ms = 25.0;
  machine.run(100, kCalm);
  machine.frame(kCalm, /*longer=*/20.0);
  machine.run(60, kCalm);
  EXPECT_EQ(machine.state.step, 0U);
}

TEST(Budget, LongFramesThatTookALotMoreThanEverAfterAreForgotten) {
  for (const double longer : {20.0, 60.0, 1000.0}) {
    Machine machine;
    machine.config.budget_ms = 25.0;
    machine.run(100, kCalm);
    for (int i = 0; i < 3; ++i) machine.frame(kCalm, longer);
    EXPECT_GT(machine.state.step, 0U);
    machine.run(400, kCalm);
    EXPECT_EQ(machine.state.step, 0U) << longer;
  }
}

TEST(Budget, AStepThatIsDearerThanTheOneBeforeItDoesNotBarTheWayBack) {
  std::vector<BudgetStep> front(4);
  front[1].ratios.fill(1.2);
  front[2].ratios.fill(0.9);
  front[3].ratios.fill(0.4);
  Machine machine;
  machine.state = start_budget(front, {});
  machine.config.budget_ms = 1.3 * machine.config.back_below * 10.0;
  machine.run(10, kCalm);
  machine.speed = 4.0;
  machine.run(100, kCalm);
  EXPECT_EQ(machine.state.step, 3U);
  machine.speed = 0.95;
  ASSERT_LT(foreseen_ms(start_budget(front, {}), 0, kCalm), 1.1 * machine.config.budget_ms);
  machine.run(1000, kCalm);
  EXPECT_EQ(machine.state.step, 0U);
}

TEST(Budget, TheFirstFrameMayTakeLong) {  // searches for the camera in the whole map
  Machine machine;
  machine.config.budget_ms = 16.0;
  machine.frame(kCalm, /*longer=*/15.0);
  machine.frame(kCalm);
  machine.frame(kCalm);
  EXPECT_EQ(machine.state.step, 0U);
}

TEST(Budget, SlowerMachineIsFoundOutInSomeFrames) {
  Machine machine;
  machine.config.budget_ms = 16.0;
  machine.run(50, kCalm);
  ASSERT_EQ(machine.state.step, 0U);
  machine.speed = 2.2;
  std::vector<double> took_ms;
  machine.run(6, kCalm);
  machine.run(100, kCalm, &took_ms);
  EXPECT_LE(p95(took_ms), 16.0);
}

TEST(Budget, WhatCannotBeHeldIsMadeAsFastAsItGoes) {
  Machine machine(3);
  machine.config.budget_ms = 5.0;
  machine.run(300, kCrowd);
  EXPECT_EQ(machine.state.step, 2U);
  machine.changes = 0;
  machine.run(300, kCrowd);
  EXPECT_EQ(machine.changes, 0);
}

TEST(Budget, APartThatIsNotMadeIsNotForeseen) {
  std::vector<BudgetStep> front(1);
  front.front().ratios[index_of(FramePart::kCompose)] = 0.0;
  const BudgetState without = start_budget(front, {});
  front.front().ratios[index_of(FramePart::kCompose)] = 1.0;
  const BudgetState with = start_budget(front, {});
  EXPECT_NEAR(foreseen_ms(with, 0, kCalm) - foreseen_ms(without, 0, kCalm),
              with.spread * nominal_ms(FramePart::kCompose, kCalm), 1e-9);
  front.front().alternates = true;
  const BudgetState alternating = start_budget(front, {});
  EXPECT_NEAR(foreseen_ms(with, 0, kCalm) - foreseen_ms(alternating, 0, kCalm),
              with.spread * nominal_ms(FramePart::kPhysics, kCalm), 1e-9);
}

TEST(Budget, WhatTurnsSaveDependsOnHowManyObjectsTakeThem) {
  // Physics alone, where each object moves in every fourth frame.
  const auto physics_ms = [](int measured_objects, double ratio, int objects) {
    std::vector<BudgetStep> front(1);
    front.front().ratios = {0.0, 0.0, ratio, 0.0};
    front.front().move_every_n_frames = 4;
    front.front().objects = measured_objects;
    const BudgetState state = start_budget(front, {});
    const FrameLoad load{.moving = objects};
    return foreseen_ms(state, 0, load) / (state.spread * nominal_ms(FramePart::kPhysics, load));
  };
  EXPECT_NEAR(physics_ms(1, 1.0, 1), 1.0, 1e-12);
  EXPECT_NEAR(physics_ms(1, 1.0, 100), 0.25, 1e-12) << "a frame moves a quarter of many";
  EXPECT_NEAR(physics_ms(50, 0.25, 50), 0.25, 1e-12);
  EXPECT_NEAR(physics_ms(50, 0.25, 2), 0.5, 1e-12) << "one of two";
  EXPECT_NEAR(physics_ms(50, 0.25, 0), 1.0, 1e-12);
  EXPECT_NEAR(physics_ms(0, 0.3, 7), 0.3, 1e-12) << "not known: as measured";
}

TEST(RunBudget, TakesTheFrontFromWhatIsAskedForOnAndKeepsWhatIsFixed) {
  Presets presets;
  for (const int stride : {1, 2, 4}) {
    FrontStep& step = presets.front.emplace_back();
    step.run.depth_stride = stride;
    step.run.shadows = stride == 1;
    step.part_ratios.fill(1.0 / stride);
  }
  EXPECT_EQ(front_for(presets, {}, {}).size(), 3U);
  EXPECT_EQ(front_for(presets, presets.front[1].run, {}).size(), 2U);
  RunQuality with_shadows;
  const auto fixed = front_for(presets, with_shadows, {{"shadows", "on"}, {"depth_stride", "1"}});
  EXPECT_EQ(fixed.size(), 1U);
  RunQuality other{.tracking_px = 100};
  FrontStep slower;
  slower.run.tracking_px = 320;
  slower.part_ratios.fill(1.8);
  presets.front.insert(presets.front.begin(), slower);
  const auto all = front_for(presets, other, {});
  ASSERT_EQ(all.size(), 3U) << "no slower one, nor the default, which is none";
  EXPECT_EQ(all.front().run, other);
  EXPECT_EQ(all.back().run.depth_stride, 4);
}

TEST(RunBudget, AStepThatAFixedFieldMakesWhatWasAskedForTakesNoneAway) {
  Presets presets;
  presets.front.resize(3);
  presets.front[1].run.soft_edges = false;
  presets.front[2].run.depth_stride = 2;
  const auto front = front_for(presets, RunQuality{.depth_stride = 2}, {{"depth_stride", "2"}});
  ASSERT_EQ(front.size(), 2U);
  EXPECT_FALSE(front[1].run.soft_edges);
}

TEST(RunBudget, APartThatIsMadeAlikeTakesTheSameWhateverWasMeasured) {
  Presets presets;
  presets.front.resize(3);
  presets.front[1].run.shadows = presets.front[2].run.shadows = false;
  presets.front[2].run.depth_stride = 2;
  presets.front[1].part_ratios = {1.1, 1.0, 1.2, 0.6};
  presets.front[2].part_ratios = {0.6, 0.3, 0.7, 0.65};
  const auto front = front_for(presets, {}, {});
  EXPECT_EQ(front[1].part_ratios, (std::array{1.0, 1.0, 1.0, 0.6}));
  EXPECT_EQ(front[2].part_ratios, (std::array{0.6, 0.3, 0.7, 0.6}));
  // With a fixed stride, the last two steps are equal and merged.
  const auto fixed = front_for(presets, RunQuality{.depth_stride = 2}, {{"depth_stride", "2"}});
  ASSERT_EQ(fixed.size(), 2U);
  EXPECT_EQ(fixed[1].part_ratios[index_of(FramePart::kLocate)],
            fixed[0].part_ratios[index_of(FramePart::kLocate)]);
}

TEST(RunBudget, ComesBackToWhatWasAskedForThoughTheFrontHasSlowerSettings) {
  Presets presets;
  for (const double ratio : {2.5, 1.8, 1.2, 0.9, 0.5}) {
    FrontStep& step = presets.front.emplace_back();
    step.run.object_error_px = 3.0 * ratio;
    step.part_ratios.fill(ratio);
  }
  for (const double default_ms : {12.0, 18.0, 22.0}) {
    double now_ms = 0.0;
    RunBudget budget(front_for(presets, {}, {}), 33.0, /*has_picture=*/true, [&] { return now_ms; });
    RunQuality quality;
    for (int frame = 0; frame < 2000; ++frame) {
      const bool has_load = frame >= 100 && frame < 160;
      for (std::size_t part = 0; part <= kFrameParts; ++part) {
        if (const auto changed = budget.before(static_cast<FramePart>(part), kCalm)) quality = *changed;
        const double ratio = quality == RunQuality{} ? 1.0 : quality.object_error_px / 3.0;
        if (part < kFrameParts)
          now_ms += ratio * (has_load ? 60.0 : default_ms) * nominal_ms(static_cast<FramePart>(part), kCalm) /
                    (nominal_ms(FramePart::kLocate, kCalm) + nominal_ms(FramePart::kMesh, kCalm) +
                     nominal_ms(FramePart::kPhysics, kCalm) + nominal_ms(FramePart::kCompose, kCalm));
      }
      budget.end_frame();
      if (frame == 140) {
        EXPECT_NE(budget.given_up(), "") << default_ms;
      }
    }
    EXPECT_EQ(budget.given_up(), "") << default_ms;
    EXPECT_EQ(quality, RunQuality{}) << default_ms;
  }
}

TEST(RunBudget, SaysWhatItGaveUpAndRecordsItAsEvents) {
  Presets presets;
  presets.front.resize(2);
  presets.front[1].run.depth_stride = 2;
  presets.front[1].part_ratios = {0.1, 0.1, 0.1, 0.1};
  double now_ms = 0.0;
  const RunQuality asked{.mesh_tolerance_sigmas = 1.0};
  for (FrontStep& step : presets.front) step.run.mesh_tolerance_sigmas = asked.mesh_tolerance_sigmas;
  RunBudget budget(front_for(presets, asked, {}), 20.0, /*has_picture=*/true, [&] { return now_ms; });
  EXPECT_EQ(budget.given_up(), "") << "what was asked for is not given up";
  budget.keep({.mode = RadarMode::kSampled, .resolution_px = 32});
  std::vector<ScriptEvent> events;
  for (int frame = 0; frame < 60; ++frame) {
    for (std::size_t part = 0; part <= kFrameParts; ++part) {
      budget.before(static_cast<FramePart>(part), kCalm);
      now_ms += 10.0;
    }
    for (const ScriptEvent& event : budget.end_frame()) events.push_back(event);
  }
  ASSERT_FALSE(events.empty());
  const RunQuality& quality = std::get<SetQuality>(events.front().action).quality;
  EXPECT_EQ(quality.depth_stride, 2);
  EXPECT_EQ(quality.radar, RadarMode::kSampled) << "the user's";
  EXPECT_EQ(quality.radar_px, 32);
  EXPECT_EQ(budget.given_up(), "depth_stride 2");
  EXPECT_EQ(budget.news(), "budget 20 ms: with depth_stride 2");
  EXPECT_EQ(budget.news(), "") << "once";
  EXPECT_EQ(budget.report()["frames"], 60);
  EXPECT_EQ(budget.report()["frames_over"], 60);
}

}  // namespace
}  // namespace roomradar::budget_test
