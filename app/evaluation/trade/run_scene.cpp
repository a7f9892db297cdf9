// run_scene.cpp: maps rooms and recordings, once for all settings, since mapping is slow.
#include "app/evaluation/trade/run_scene.hpp"

#include <cmath>
#include <numbers>

#include "app/evaluation/trade/kept_frames.hpp"
#include "app/evaluation/trade/trade_frames.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {
namespace {

constexpr std::int64_t kJudgeEvery = 7;  // pictures are compared every this many frames; no multiple of
                                         // picture_every_n_frames
constexpr std::int64_t kFirstJudged = 15;

SavedMap mapped(FrameSource& source) {
  PrescanConfig config;
  config.poses = PoseOrigin::kRecorded;
  config.remove_ghosts = false;  // nothing moves during the scan
  StageTimes times;
  return std::move(prescan(source, config, times).map);
}

void add_run_frames(const SimOptions& options, RunScene& scene) {
  SimulatedSource source(options);
  for (Frame frame; source.next(frame).status == ReadStatus::kFrame;) {
    scene.frames.push_back(frame);
    if (frame.index >= kFirstJudged && frame.index % kJudgeEvery == 0)
      scene.true_views.push_back({scene.frames.size() - 1, source.truth().depth_m});
  }
}

/// Returns places in a ring around the room's focus, on the first surface below each.
std::vector<Eigen::Vector3d> drop_places(const Room& room, const Eigen::Isometry3d& T_world_room) {
  constexpr int kPlaces = 8;
  constexpr double kRing_m = 0.25, kAbove_m = 0.3;
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < kPlaces; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPlaces;
    const Eigen::Vector3d from_room =
        room.focus_world + Eigen::Vector3d(kRing_m * std::cos(angle), kRing_m * std::sin(angle), kAbove_m);
    const auto hit = cast_ray(room, from_room, -Eigen::Vector3d::UnitZ());
    if (hit) places.push_back(T_world_room * (from_room - hit->range_m * Eigen::Vector3d::UnitZ()));
  }
  return places;
}

/// Renders all frames that a trial can need.
void render_ahead(PreparedScenario& prepared) {
  const Scenario& scenario = prepared.scenario;
  if (scenario.occluder_velocity_world.isZero()) return;
  const int steps = static_cast<int>(std::ceil(scenario.limit_m / step_m(scenario)));
  for (int number = 0; number < steps; ++number) prepared.frames.at(number);
}

}  // namespace

std::unique_ptr<RunScene> run_scene_of_room(const std::string& spec, const TradeScale& scale) {
  auto scene = std::make_unique<RunScene>();
  SimOptions run = parse_sim_spec("sim:" + spec);
  run.depth_camera = kinect_of_width(scale.run_px);
  run.frames = scale.run_frames;
  run.path = CameraPathKind::kView;
  run.movers = {MoverKind::kHand, MoverKind::kPerson};
  scene->name = sim_spec(run);
  scene->room = std::make_unique<ScenarioRoom>(make_scenario_room(run.room, run.seed));

  SimOptions scan = scene->room->prescan;  // the path that the scenarios assume, in fewer frames
  scan.rate_hz *= static_cast<double>(scale.map_frames) / static_cast<double>(scan.frames);
  scan.frames = scale.map_frames;
  scan.depth_camera = run.depth_camera;
  SimulatedSource source(scan);
  scene->map = mapped(source);
  scene->mesh_room = transformed(scene->map.mesh, scene->map.info.T_world_recorded.inverse());
  add_run_frames(run, *scene);
  for (int number = 0; number < scale.scenarios; ++number) {
    scene->scenarios.push_back(std::make_unique<PreparedScenario>(*scene->room, run.seed, number));
    render_ahead(*scene->scenarios.back());
  }
  scene->touches = draw_dynamic_touches(scene->scenarios, scene->room->room);
  scene->drop_at_world = drop_places(scene->room->room, scene->map.info.T_world_recorded);
  return scene;
}

std::unique_ptr<RunScene> run_scene_of_recording(const std::string& folder, const TradeScale& scale) {
  auto scene = std::make_unique<RunScene>();
  scene->name = folder;
  const std::vector<Frame> all = frames_of_recording(folder, scale.map_frames + scale.run_frames);
  const std::size_t run_frames = std::min(all.size() / 2, static_cast<std::size_t>(scale.run_frames));
  const auto middle = all.end() - static_cast<std::ptrdiff_t>(run_frames);
  const std::vector<Frame> scanned(all.begin(), middle);
  KeptFrames source(scanned, folder);
  scene->map = mapped(source);
  scene->frames.assign(middle, all.end());
  return scene;
}

}  // namespace roomradar
