// run_work.cpp: measures one run in a child process: times, memory, errors.
#include "app/evaluation/trade/run_work.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "app/evaluation/trade/measured_sandboxed.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::array kStages{"reduce", "locate", "expected", "foreground",
                             "mesh",   "radar",  "physics",  "compose"};

std::vector<FigureName> run_figures() {
  using Kind = FigureKind;
  std::vector<FigureName> names = {{"frame_mean_ms", "frame, mean, ms", 1.0, Kind::kTime},
                                   {"frame_ms", "frame, median, ms", 1.0, Kind::kTime},
                                   {"frame_p95_ms", "frame, p95, ms", 1.0, Kind::kTime},
                                   {"contact_ms", "depth to contact, median, ms", 1.0, Kind::kTime},
                                   {"cpu_ms", "CPU time, all threads, ms per frame", 1.0, Kind::kTime}};
  for (const char* stage : kStages)
    names.push_back({std::string(stage) + "_ms", std::string(stage) + ", ms", 1.0, Kind::kTime});
  for (FigureName& name : std::vector<FigureName>{
           {"moved_ms", "physics, mean of frames in which objects are moved, ms", 1.0, Kind::kTime},
           {"memory_mb", "peak memory of the process, MB", 1.0, Kind::kMemory},
           {"dynamic_triangles", "dynamic triangles", 1.0, Kind::kFact},
           {"static_triangles", "triangles of the room, drawn", 1.0, Kind::kFact},
           {"pose_error_m", "camera position, RMS error, mm", 1e3, Kind::kError, 0.001},
           {"not_located", "frames not located, %", 1e2, Kind::kError, 0.01},
           {"contact_error_median_m", "contact error on hidden surfaces, median, mm", 1e3, Kind::kError,
            0.0005},
           {"contact_error_p95_m", "contact error on hidden surfaces, p95, mm", 1e3, Kind::kError, 0.002},
           {"passed_through", "fell through, %", 1e2, Kind::kError, 0.005},
           {"false_stops", "stopped in empty space, %", 1e2, Kind::kError, 0.02},
           {"moved_error_median_m", "contact error on dynamic objects, median, mm", 1e3, Kind::kError,
            0.0005},
           {"moved_error_p95_m", "contact error on dynamic objects, p95, mm", 1e3, Kind::kError, 0.002},
           {"moved_missed", "passed through dynamic objects, %", 1e2, Kind::kError, 0.005},
           {"picture_error", "picture error, % of an object's pixels", 1e2, Kind::kError, 0.002},
           {"picture_edge_error", "picture error at occlusion edges, %", 1e2, Kind::kError, 0.002},
           {"object_age_ms", "age of an object's pose in the picture, ms", 1.0, Kind::kError, 20.0}})
    names.push_back(std::move(name));
  return names;
}

/// Sums the errors over all true views.
PictureErrors picture_errors(const RunScene& scene, const RunSetting& setting, const Mesh& object,
                             const RunFacts& facts) {
  PictureJudge judge(std::vector<Mesh>(static_cast<std::size_t>(setting.objects), object));
  PictureErrors errors;
  for (std::size_t i = 0; i < facts.pictures.size(); ++i) {
    const TrueView& view = scene.true_views[i];
    const Frame& frame = scene.frames[view.frame];
    errors += judge.errors_of(facts.pictures[i], frame, view.depth_m,
                              scene.map.info.T_world_recorded * *frame.T_world_camera);
  }
  return errors;
}

Readings measure(const RunScene& scene, const Setting& words) {
  const RunSetting setting = run_setting_of(words);
  const Mesh object = object_mesh("teapot");
  const RunFacts facts = run_session(scene, setting, object);
  const PictureErrors picture = picture_errors(scene, setting, object, facts);
  const ContactFacts contact = touch_true_surfaces(scene, setting.quality);

  const auto stages = facts.times.summaries();
  const auto of_stage = [&](const char* stage, double StageSummary::*figure = &StageSummary::median_ms) {
    const auto found = stages.find(stage);
    return found == stages.end() ? kNotMeasured : found->second.*figure;
  };
  Readings figures = {facts.frame_ms, of_stage("frame"), of_stage("frame", &StageSummary::p95_ms),
                      of_stage("contact"), facts.cpu_ms};
  for (const char* stage : kStages) figures.push_back(of_stage(stage));
  for (const double figure :
       {facts.moved_ms, facts.memory_mb, facts.dynamic_triangles, facts.static_triangles, facts.pose_error_m,
        1.0 - facts.located, contact.error_median_m, contact.error_p95_m, contact.passed, contact.false_stops,
        contact.moved.error_median_m, contact.moved.error_p95_m, contact.moved.missed, picture.whole(),
        picture.at_edges(), facts.object_age_ms})
    figures.push_back(figure);
  return figures;
}

}  // namespace

std::vector<Parameter> run_parameters(int objects) {
  std::vector<Parameter> parameters = {
      {"depth_stride", {"4", "2", "1"}, 2},
      {"tracking_px", {"80", "160", "320"}, 1},
      {"verify_every_n_frames", {"30", "5", "1"}, 2},
      {"mesh_tolerance_sigmas", {"3.2", "1.6", "0.8", "0.4"}, 2},
      {"fine_mesh", {"off", "on"}, 0},
      {"radar", {"sampled", "passes", "exact"}, 2},
      {"radar_px", {"16", "32", "64", "128"}, 2},
      {"move_every_n_frames", {"8", "4", "2", "1"}, 3},
      {"object_error_px", {"6", "3", "2", "1", "0.7", "0.35"}, 4},
      {"soft_edges", {"off", "on"}, 1},
      {"bridge_gaps", {"off", "on"}, 1},
      {"shadows", {"off", "on"}, 1},
      {"shadow_every_n_frames", {"1000", "8", "3", "1"}, 3},
      {"picture_every_n_frames", {"2", "1"}, 1},
      {"physics_step_s",
       {"0.15", "0.06666666666666667", "0.03333333333333333", "0.016666666666666666", "0.008333333333333333"},
       3},
      {"objects", {"1", "5", "20"}, 0, /*is_load=*/true}};
  Parameter& load = parameters.back();
  const auto defaults = std::find(load.words.begin(), load.words.end(), std::to_string(objects));
  if (defaults == load.words.end())
    throw Error("trade: objects = " + std::to_string(objects) + ": must be 1, 5 or 20");
  load.defaults = static_cast<std::size_t>(defaults - load.words.begin());
  return parameters;
}

RunSetting run_setting_of(const Setting& levels) {
  RunSetting setting;
  const std::vector<Parameter> parameters = run_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string& word = parameters[i].words[levels[i]];
    if (parameters[i].is_load)
      setting.objects = std::atoi(word.c_str());
    else
      set_field(setting.quality, parameters[i].name, word);
  }
  return setting;
}

MeasuredWork run_work(const std::vector<std::string>& rooms, const std::vector<std::string>& recordings,
                      const TradeScale& scale, int objects) {
  MeasuredWork work{
      .name = "run", .parameters = run_parameters(objects), .figures = run_figures(), .scenes = rooms};
  work.scenes.insert(work.scenes.end(), recordings.begin(), recordings.end());
  work.open = [rooms, recordings, scale](std::size_t number) -> Measure {
    const std::shared_ptr<const RunScene> scene =
        number < rooms.size() ? run_scene_of_room(rooms[number], scale)
                              : run_scene_of_recording(recordings[number - rooms.size()], scale);
    return [scene](const Setting& setting) {
      return measured_sandboxed("run in " + scene->name, [&] { return measure(*scene, setting); });
    };
  };
  return work;
}

}  // namespace roomradar
