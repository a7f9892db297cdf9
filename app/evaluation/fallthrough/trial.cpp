// trial.cpp: moves the object step by step until the radar stops it.
#include "app/evaluation/fallthrough/trial.hpp"

#include <algorithm>

#include "dynamic/surface/reduced_depth.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

namespace {

/// Returns the frame itself if the stride is 1, otherwise `reduced`.
const Frame& reduced_by(int stride, const Frame& frame, Frame& reduced) {
  stride = usable_stride(frame.depth_camera, stride);
  if (stride == 1) return frame;
  reduce_depth(frame, stride, reduced);
  return reduced;
}

}  // namespace

const Frame& ScenarioFrames::at(int number) {
  if (scenario_.occluder_velocity_world.isZero()) number = 0;
  const auto [entry, is_new] = frames_.try_emplace(number);
  if (is_new) render_scenario(scenario_, room_, number, /*noise_scale=*/1.0, entry->second);
  return entry->second;
}

PreparedScenario::PreparedScenario(const ScenarioRoom& room, std::uint64_t seed, std::int64_t number)
    : scenario(make_scenario(room, seed, number)), frames(scenario, room.room) {
  object.build_by_place(scenario.object_mesh);
  frames.at(0);
}

Trial run_trial(PreparedScenario& prepared, MappedRoom& room, std::size_t policy, Radar& radar,
                const WatchTrial& watch) {
  return run_trial(prepared, *room.scenes[policy], {.policy = kFallthroughPolicies[policy].surfaces}, radar,
                   watch);
}

double show_frame(PreparedScenario& prepared, int number, const TrialSurfaces& how,
                  std::span<const FineRegion> about_objects, FrameScene& scene) {
  const Scenario& scenario = prepared.scenario;
  Frame reduced;
  const Frame& frame = reduced_by(how.depth_stride, prepared.frames.at(number), reduced);
  const bool has_map = how.policy == SurfacePolicy::kMap;
  if (has_map && number == 0)  // replaces the foreground's one-frame history, which is another scenario's
    scene.find_dynamic(frame, scene.render_expected(frame.depth_camera, scenario.T_world_camera));
  if (!how.fine_mesh) about_objects = {};
  const auto start = std::chrono::steady_clock::now();
  if (has_map) {
    const ExpectedView& expected = scene.render_expected(frame.depth_camera, scenario.T_world_believed);
    const FrameForeground& foreground = scene.find_dynamic(frame, expected);
    scene.mesh_surfaces(frame, scenario.T_world_believed, expected, foreground, about_objects);
  } else {
    scene.mesh_all_pixels(frame, scenario.T_world_believed);
  }
  return ms_since(start);
}

Trial run_trial(PreparedScenario& prepared, FrameScene& scene, const TrialSurfaces& how, Radar& radar,
                const WatchTrial& watch) {
  using Clock = std::chrono::steady_clock;
  constexpr double kAbout_m = 0.02;  // as in Session
  constexpr double kArrived_m = 0.001;
  const Scenario& scenario = prepared.scenario;
  const bool is_still = scenario.occluder_velocity_world.isZero();
  Trial trial;
  std::vector<SceneTree> surfaces;
  FineRegion about_object{scenario.T_world_object.translation(), scenario.object.reach_m + kAbout_m};
  double query_ms = 0.0;
  int frame_number = 0;
  for (bool stopped = false; !stopped && trial.travelled_m < scenario.limit_m; ++frame_number) {
    about_object.centre_world =
        scenario.T_world_object.translation() + trial.travelled_m * scenario.direction_world;
    if (frame_number == 0 || !is_still) {
      const double made_ms = show_frame(prepared, frame_number, how, {&about_object, 1}, scene);
      surfaces = scene.surfaces();
      if (frame_number == 0) trial.frame_ms = made_ms;
    }
    const double from_m = trial.travelled_m;
    const double next_m = std::min(step_m(scenario), scenario.limit_m - from_m);
    const Eigen::Isometry3d T_world_object =
        Eigen::Translation3d(from_m * scenario.direction_world) * scenario.T_world_object;
    const auto start = Clock::now();
    const Contact contact =
        radar.query({{&prepared.object, T_world_object}, scenario.direction_world, next_m}, {surfaces, {}});
    query_ms += ms_since(start);
    // Objects move by the lower bound, and stop where the bounds agree. Beyond CyberRadar::kMostWorkBehind
    // the lower bound is 0, and the radar's estimate counts.
    const double free_m =
        contact.status == ContactStatus::kOverlap ? 0.0 : std::clamp(contact.lower_m, 0.0, next_m);
    const bool do_bounds_agree = contact.upper_m - free_m < kArrived_m;
    const bool is_undecided = !(free_m > 0.0) && !do_bounds_agree;
    stopped = contact && (do_bounds_agree || is_undecided);
    const double estimate_m = contact ? std::max(0.0, contact.contact_distance_m) : next_m;
    trial.travelled_m += is_undecided ? estimate_m : free_m;
    if (stopped) trial.rested_on = contact.touched;
    const bool is_last = stopped || trial.travelled_m >= scenario.limit_m;
    if (watch) watch({frame_number, surfaces, from_m, trial.travelled_m, is_last});
  }
  trial.frame_ms += query_ms / frame_number;
  trial.verdict = judge(scenario, trial.travelled_m);
  return trial;
}

}  // namespace roomradar
