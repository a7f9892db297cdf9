// run_facts.cpp: steps a session as a run does, and compares with ground truth.
#include "app/evaluation/trade/run_facts.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "app/cli/report.hpp"
#include "app/evaluation/fallthrough/totals.hpp"
#include "app/evaluation/trade/measured_sandboxed.hpp"
#include "app/session/apply_quality.hpp"
#include "app/session/script/session_events.hpp"
#include "app/session/session.hpp"
#include "mapping/types/system/process_memory.hpp"
#include "radar/batch/passes_radar.hpp"

namespace roomradar {
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
                     [](const auto& object) { return object->in_room && object->waited_s == 0.0; });
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
        if (object->in_room) waited_s_.push_back(object->waited_s);
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
