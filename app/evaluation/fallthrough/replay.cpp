// replay.cpp: draws a panel per policy, with several pictures per step.
#include "app/evaluation/fallthrough/replay.hpp"

#include <algorithm>
#include <array>

#include "app/evaluation/fallthrough/trial_pictures.hpp"
#include "app/media/canvas.hpp"
#include "app/media/video_writer.hpp"

namespace roomradar {
namespace {

constexpr int kPanel_px = 320, kColumns = 3, kRows = 2;
static_assert(kPolicyCount + 1 <= static_cast<std::size_t>(kColumns * kRows));

/// Content of a policy's panel, frame by frame.
struct Panel {
  struct Step {
    ColourImage section;
    double from_m, to_m;
  };
  std::vector<Step> steps;
  Trial trial;
};

}  // namespace

void write_replay(PreparedScenario& prepared, MappedRoom& room, Radar& radar, VideoWriter& video) {
  constexpr double kShown_s = 4.0;
  const Scenario& scenario = prepared.scenario;
  const SideView side(scenario, room.scanned.simulated.room, kPanel_px, kPanel_px);
  std::array<Panel, kPolicyCount> panels;
  std::size_t most_steps = 1;
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    panels[i].trial = run_trial(prepared, room, i, radar, [&](const TrialStep& step) {
      const bool as_before = !panels[i].steps.empty() && scenario.occluder_velocity_world.isZero();
      ColourImage section = as_before ? panels[i].steps.back().section : side.room_at(step.frame);
      if (!as_before) side.add_surfaces(step.surfaces, section);
      panels[i].steps.push_back({std::move(section), step.from_m, step.to_m});
    });
    most_steps = std::max(most_steps, panels[i].steps.size());
  }
  const int slow =
      std::max(2, static_cast<int>(kReplayPicturesPerS * kShown_s / static_cast<double>(most_steps)));
  ColourImage picture(kColumns * kPanel_px, kRows * kPanel_px);
  const auto show = [&](std::size_t step, double part) {
    picture.resize(picture.width, picture.height, Rgb{255, 255, 255});
    ColourImage view = camera_view(
        scenario, prepared.frames.at(static_cast<int>(std::min(step, most_steps - 1))), kPanel_px);
    add_outline(scenario,
                std::min((static_cast<double>(step) + part) * step_m(scenario), scenario.true_travel_m),
                kTruthColour, 0.3, view);
    paste(view, 0, 40, picture);
    draw_text(picture, "camera; object as in truth", 8, 24, 0.5, {30, 30, 30});
    for (std::size_t i = 0; i < kPolicyCount; ++i) {
      const auto& steps = panels[i].steps;
      const auto& now = steps[std::min(step, steps.size() - 1)];
      const double now_part = step < steps.size() ? part : 1.0;
      ColourImage section = now.section;
      side.add_object(scenario.true_travel_m, kTruthColour, 0.1, section);
      side.add_object(now.from_m + now_part * (now.to_m - now.from_m), kEndColour, 0.4, section);
      std::string title(kFallthroughPolicies[i].name);
      if (step >= steps.size()) title += ": " + std::string(to_string(panels[i].trial.verdict.outcome));
      draw_text(section, title, 8, 20, 0.5, {30, 30, 30});
      const int place = static_cast<int>(i) + 1;
      paste(section, place % kColumns * kPanel_px, place / kColumns * kPanel_px, picture);
    }
    video.write(picture);
  };
  for (std::size_t step = 0; step < most_steps; ++step)
    for (int i = 0; i < slow; ++i) show(step, static_cast<double>(i) / slow);
  for (int i = 0; i < static_cast<int>(kReplayPicturesPerS); ++i) show(most_steps, 1.0);
  video.close();
}

}  // namespace roomradar
