// run_facts.cpp: steps a session as a run does, and compares with ground truth.
#include "app/evaluation/trade/run_facts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "app/cli/report.hpp"
#include "app/evaluation/fallthrough/totals.hpp"
#include "app/evaluation/trade/measured_sandboxed.hpp"
#include "app/evaluation/trade/trade_frames.hpp"
#include "app/session/apply_quality.hpp"
#include "app/session/script/session_events.hpp"
#include "app/session/session.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sim/solids/swept_travel.hpp"
#include "app/sim/solids/view_caster.hpp"
#include "mapping/prescan.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/process_memory.hpp"
#include "radar/batch/passes_radar.hpp"

namespace roomradar {
namespace {

constexpr int kTouchesEach = 4, kDraws = 60;
constexpr double kNearest_m = 0.8, kFarthest_m = 3.5;
constexpr double kBefore_m = 0.25;  // distance of the ball's start from the surface
constexpr double kAlone_m = 0.05;   // the room must be at least this much farther than the occluder

Solid ball() { return sphere(Eigen::Vector3d::Zero(), kTouchRadius_m); }

/// Returns the ball's distance to contact with the solids; infinite if it touches none.
double travel_to(std::span<const Solid> solids, const DynamicTouch& touch) {
  const std::vector<Solid> parts{ball()};
  const Eigen::Isometry3d T_world_ball(Eigen::Translation3d(touch.start_world));
  const SweptTravel swept = swept_travel(solids, parts, T_world_ball, touch.direction_world, kTouchLimit_m);
  return swept.touches ? swept.contact_distance_m : std::numeric_limits<double>::infinity();
}

void draw_touches_of(const Scenario& scenario, std::size_t number, const Room& room,
                     std::vector<DynamicTouch>& touches) {
  const std::vector<Solid> moved = occluder_at(scenario, 0);
  std::vector<Solid> solids = room.solids;
  solids.insert(solids.end(), moved.begin(), moved.end());
  const Intrinsics& camera = scenario.depth_camera;
  ViewCaster view;
  view.prepare(solids, camera, scenario.T_world_camera);
  CounterRandom random(scenario.seed, static_cast<std::uint64_t>(scenario.number));
  int found = 0;
  for (int draw = 0; draw < kDraws && found < kTouchesEach; ++draw) {
    const double u = random.uniform(0.0, camera.width_px), v = random.uniform(0.0, camera.height_px);
    const PixelHit hit = view.cast(u, v);
    if (hit.solid < static_cast<int>(room.solids.size())) continue;
    if (hit.depth_m < kNearest_m || hit.depth_m > kFarthest_m) continue;
    const Eigen::Vector3d p_camera = back_project(camera, u, v, hit.depth_m);
    DynamicTouch touch{.scenario = number};
    touch.direction_world = (scenario.T_world_camera.linear() * p_camera).normalized();
    touch.start_world = scenario.T_world_camera * p_camera - kBefore_m * touch.direction_world;
    touch.true_travel_m = travel_to(moved, touch);
    if (!std::isfinite(touch.true_travel_m) || touch.true_travel_m == 0.0) continue;
    if (travel_to(room.solids, touch) < touch.true_travel_m + kAlone_m) continue;
    touches.push_back(touch);
    ++found;
  }
}

/// Draws at random up to 4 balls for each scenario with an occluder that was absent from the prescan. Each
/// ball flies along the ray of a pixel that shows the occluder at 0.8 to 3.5 m, and would touch the occluder
/// at least 5 cm before the room.
std::vector<DynamicTouch> draw_dynamic_touches(
    const std::vector<std::unique_ptr<PreparedScenario>>& scenarios, const Room& room) {
  std::vector<DynamicTouch> touches;
  for (std::size_t i = 0; i < scenarios.size(); ++i)
    if (!scenarios[i]->scenario.occluder_solids.empty())
      draw_touches_of(scenarios[i]->scenario, i, room, touches);
  return touches;
}

/// Measures the contacts of all balls with the radar.
/// @param touches  balls, sorted by scenario
/// @param how      its policy must be kMap. With fine_mesh, the mesh is fine within 2 cm of the ball at each
///                 true contact
DynamicTouchFacts judge_dynamic_touches(const std::vector<DynamicTouch>& touches,
                                        const std::vector<std::unique_ptr<PreparedScenario>>& scenarios,
                                        FrameScene& scene, const TrialSurfaces& how, Radar& radar) {
  if (touches.empty()) return {};
  constexpr double kAbout_m = 0.02;  // as in Session
  Mesh ball_mesh;
  append_mesh(ball(), {}, kMeshDeviation_m, ball_mesh);
  TriangleTree tree;
  tree.build_by_place(ball_mesh);
  std::vector<double> errors_m;
  int missed = 0;
  for (std::size_t first = 0; first < touches.size();) {
    std::size_t end = first;
    std::vector<FineRegion> fine;
    for (; end < touches.size() && touches[end].scenario == touches[first].scenario; ++end)
      fine.push_back({touches[end].start_world + touches[end].true_travel_m * touches[end].direction_world,
                      kTouchRadius_m + kAbout_m});
    (void)show_frame(*scenarios[touches[first].scenario], 0, how, fine, scene);
    const std::vector<SceneTree> surfaces = scene.surfaces();
    for (; first < end; ++first) {
      const DynamicTouch& touch = touches[first];
      const Eigen::Isometry3d T_world_ball(Eigen::Translation3d(touch.start_world));
      const Contact contact =
          radar.query({{&tree, T_world_ball}, touch.direction_world, kTouchLimit_m}, {surfaces, {}});
      const double past_m = contact.contact_distance_m - touch.true_travel_m;
      if (contact && past_m <= kTooFar_m)  // otherwise it passed through
        errors_m.push_back(std::abs(past_m));
      else
        ++missed;
    }
  }
  return {percentile(errors_m, 0.5), percentile(errors_m, 0.95),
          static_cast<double>(missed) / static_cast<double>(touches.size())};
}

}  // namespace

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

namespace {

constexpr std::size_t kWarmUpFrames = 10;
constexpr int kDropEvery = 25;

void drop_objects(const RunScene& scene, int objects, int frame, Session& session) {
  for (int number = 0; number < objects; ++number) {
    if (frame > 0 && (frame + number * kDropEvery / objects) % kDropEvery != 0) continue;
    DropObject drop{.name = std::to_string(number), .height_m = 0.2};
    const auto turn = static_cast<std::size_t>(frame / kDropEvery + number);
    if (!scene.drop_at_world.empty())
      drop.position_world = scene.drop_at_world[turn % scene.drop_at_world.size()];
    apply(session, {drop});
  }
}

JudgedPicture shown_by(const Session& session) {
  JudgedPicture shown{session.picture(), {}};
  for (std::size_t i = 0; i < session.objects().size(); ++i)
    if (session.objects()[i]->in_room)
      shown.objects.push_back({i, session.objects()[i]->body.T_world_object});
  return shown;
}

bool moved_some(const Session& session) {
  return std::any_of(session.objects().begin(), session.objects().end(),
                     [](const auto& object) { return object->in_room && object->placement.waited_s == 0.0; });
}

double newest_ms(const StageTimes& times, std::string_view wanted) {
  double newest = 0.0;
  times.visit_newest([&](const std::string& stage, std::size_t, double ms) {
    if (stage == wanted) newest = ms;
  });
  return newest;
}

/// Mean age of the object poses shown, over frames: objects wait for their turn, and so does the picture.
class ShownAge {
 public:
  void note(const Session& session, const FrameResult& result, double stamp_s, bool counts) {
    if (result.picture_is_new) {
      made_s_ = stamp_s;
      waited_s_.clear();
      for (const auto& object : session.objects())
        if (object->in_room) waited_s_.push_back(object->placement.waited_s);
    }
    if (!counts) return;
    for (const double waited_s : waited_s_) sum_s_ += waited_s + (stamp_s - made_s_);
    count_ += waited_s_.size();
  }
  [[nodiscard]] double mean_ms() const { return 1e3 * sum_s_ / static_cast<double>(count_); }

 private:
  std::vector<double> waited_s_;  ///< per object in the picture, when it was made
  double made_s_ = 0.0, sum_s_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace

RunFacts run_session(const RunScene& scene, const RunSetting& setting, const Mesh& object) {
  const std::size_t start_bytes = resident_bytes();
  SessionConfig config;
  apply(setting.quality, config);
  config.picture.light.samples_per_s = 0;  // PictureJudge draws in the default light, without grain
  config.picture.has_grain = false;
  Session session(scene.map, config);
  for (int number = 0; number < setting.objects; ++number) session.add_object(std::to_string(number), object);

  RunFacts facts;
  facts.renderer = session.renderer();
  StageTimes warm_up;
  ShownAge shown;
  int counted = 0, located = 0, moved = 0;
  double squared_error_m2 = 0.0;
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    const Frame& frame = scene.frames[i];
    drop_objects(scene, setting.objects, static_cast<int>(i), session);
    const bool counts = i >= kWarmUpFrames;
    const double cpu_before_ms = process_cpu_ms();
    const FrameResult result = session.step(frame, counts ? facts.times : warm_up);
    const double cpu_ms = process_cpu_ms() - cpu_before_ms;
    const std::size_t judged = facts.pictures.size();
    if (judged < scene.true_views.size() && scene.true_views[judged].frame == i)
      facts.pictures.push_back(shown_by(session));
    shown.note(session, result, frame.stamp_s, counts);
    if (!counts) continue;
    facts.frame_ms += newest_ms(facts.times, "frame");
    facts.cpu_ms += cpu_ms;
    ++counted;
    if (result.status != FrameStatus::kDone) continue;
    ++located;
    if (moved_some(session)) {
      facts.moved_ms += newest_ms(facts.times, "physics");
      ++moved;
    }
    facts.dynamic_triangles += static_cast<double>(result.dynamic_triangles);
    facts.static_triangles += static_cast<double>(result.static_triangles_drawn);
    const Eigen::Isometry3d T_world_true = scene.map.info.T_world_recorded * *frame.T_world_camera;
    squared_error_m2 += (T_world_true.translation() - result.T_world_camera.translation()).squaredNorm();
  }
  facts.memory_mb = peak_growth_mb(start_bytes);
  facts.frame_ms /= counted;
  facts.cpu_ms /= counted;
  facts.moved_ms /= moved;
  facts.located = static_cast<double>(located) / counted;
  facts.dynamic_triangles /= located;
  facts.static_triangles /= located;
  facts.pose_error_m = std::sqrt(squared_error_m2 / located);
  facts.object_age_ms = shown.mean_ms();
  return facts;
}

ContactFacts touch_true_surfaces(const RunScene& scene, const RunQuality& quality) {
  if (scene.scenarios.empty()) return {};
  SessionConfig config;
  apply(quality, config);
  GlContext context;
  Shape shape(context);
  shape.set(scene.mesh_room, MeshUsage::kStatic);
  FrameScene live(context, shape, config.scene);
  const std::unique_ptr<Radar> radar = make_radar(config.radar, context);
  const TrialSurfaces how{
      .policy = SurfacePolicy::kMap, .depth_stride = config.depth_stride, .fine_mesh = config.fine_mesh};
  std::vector<double> errors_m;
  int passed = 0, false_stops = 0;
  for (const auto& prepared : scene.scenarios) {
    const Trial trial = run_trial(*prepared, live, how, *radar);
    passed += trial.verdict.outcome == Outcome::kPassedThrough ? 1 : 0;
    false_stops += trial.verdict.outcome == Outcome::kStoppedFalse ? 1 : 0;
    if (trial.rested_on != SurfaceKind::kNothing) errors_m.push_back(std::abs(trial.verdict.error_m));
  }
  const auto count = static_cast<double>(scene.scenarios.size());
  return {.error_median_m = percentile(errors_m, 0.5),
          .error_p95_m = percentile(errors_m, 0.95),
          .passed = passed / count,
          .false_stops = false_stops / count,
          .moved = judge_dynamic_touches(scene.touches, scene.scenarios, live, how, *radar)};
}

}  // namespace roomradar
