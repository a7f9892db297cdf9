// frame_bench.cpp: whole frames of a session in a saved room: time per stage, latency until a contact is
// known, and accuracy.
//
// usage: frame_bench [--scene NAME]... [--object TRIANGLES]... [--maps FOLDER] [--json FILE] [--slow MS]
// --slow: prints the stage times of each frame that takes longer. The program links few libraries, so it can
// run on another machine: copy it with the maps and the libraries that ldd lists. The scenes room and walk
// need nothing else there. Scenes: kitchen (frames 400-499 of the recording, in the map of 0-399; omitted
// with a message if the recording is absent), room (a simulated dining room with a hand, hand-held camera),
// walk (the same room, camera walking around it). Maps are made once and kept in FOLDER (frame-bench-maps).
// An object is dropped into view every 25 frames. The first 10 frames are not counted. Reference: drawing the
// whole map's depth with OpenGL at the frames' poses, before and after each row. Scenes, seeds and frames are
// fixed: changing them breaks the comparison with earlier results.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/report.hpp"
#include "app/session/script/session_events.hpp"
#include "app/session/session.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/bench_times.hpp"
#include "tests/bench/frame_bench_pipe.hpp"
#include "tests/bench/radar_bench_shapes.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar {
namespace {

constexpr int kWarmUpFrames = 10;
constexpr std::size_t kMotionFrames = 10;
constexpr int kDropEvery = 25;
constexpr double kDropHeight_m = 0.2;

struct Scene {
  std::string name;
  std::string scanned, run;  ///< sources
  std::optional<FrameRange> scanned_frames;
  FrameRange run_frames;
};

std::vector<Scene> scenes() {
  std::vector<Scene> all = {{.name = "room",
                             .scanned = "sim:table?seed=1&frames=360&rate=15",
                             .run = "sim:table?seed=7&frames=110&path=view&moving=hand",
                             .scanned_frames = {},
                             .run_frames = {0, 109}},
                            {.name = "walk",
                             .scanned = "sim:table?seed=1&frames=360&rate=15",
                             .run = "sim:table?seed=3&frames=720&moving=hand",
                             .scanned_frames = {},
                             .run_frames = {100, 209}}};
  if (const auto kitchen = test::recording("kitchen")) {
    all.insert(all.begin(), {.name = "kitchen",
                             .scanned = kitchen->string(),
                             .run = kitchen->string(),
                             .scanned_frames = FrameRange{0, 399},
                             .run_frames = {400, 499}});
  } else {
    std::fprintf(stderr,
                 "kitchen is left out: the recording is not here; set ROOMRADAR_DATA to its folder\n");
  }
  return all;
}

struct Settings {
  std::vector<std::string> scenes;
  std::vector<std::size_t> objects;
  std::filesystem::path maps = "frame-bench-maps";
  std::string json;
  double slow_ms = 0.0;  ///< 0: report no frame
};

/// Prints the stages of a frame that took longer than slow_ms; omits stages below 0.5 ms.
void say_if_slow(double slow_ms, std::int64_t frame, const StageTimes& times,
                 std::map<std::string, std::size_t>& counts) {
  std::string text;
  bool is_slow = false;
  times.visit_newest([&](const std::string& stage, std::size_t count, double newest_ms) {
    if (std::exchange(counts[stage], count) == count) return;
    is_slow |= stage == "frame" && newest_ms > slow_ms;
    if (newest_ms < 0.5) return;
    std::array<char, 64> part;
    std::snprintf(part.data(), part.size(), " %s %.1f", stage.c_str(), newest_ms);
    text += part.data();
  });
  if (is_slow && slow_ms > 0.0)
    std::fprintf(stderr, "frame %lld:%s\n", static_cast<long long>(frame), text.c_str());
}

std::string range_text(const FrameRange& frames) {
  return std::to_string(frames.first) + ":" + std::to_string(frames.last);
}

/// Reading recordings and scanning rooms is done by a program beside this one, so this program also runs on
/// machines without the libraries that they need.
std::string reader_command(const std::vector<std::string>& arguments) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  std::string command = "'" + (folder / "frame_bench_reader").string() + "'";
  for (const std::string& argument : arguments) command += " '" + argument + "'";
  return command;
}

/// Scenes scanned from the same source share a map.
SavedMap map_of(const Scene& scene, const std::filesystem::path& maps) {
  const std::filesystem::path folder = maps / (scene.name == "walk" ? "room" : scene.name);
  if (!std::filesystem::exists(folder)) {
    std::fprintf(stderr, "%s: scanning %s\n", folder.c_str(), scene.scanned.c_str());
    std::vector<std::string> arguments = {"scan", scene.scanned};
    if (scene.scanned_frames) arguments.push_back(range_text(*scene.scanned_frames));
    arguments.push_back(folder.string());
    if (std::system(reader_command(arguments).c_str()) != 0)
      throw Error(folder.string() + ": is not there, and the scan that makes it failed");
  }
  return load_map(folder);
}

std::vector<Frame> read_frames(const Scene& scene) {
  std::vector<Frame> frames;
  if (scene.run.starts_with("sim:")) {
    SimulatedSource source(parse_sim_spec(scene.run));
    for (Frame frame; source.next(frame).status == ReadStatus::kFrame;) {
      if (frame.index >= scene.run_frames.first) frames.push_back(frame);
      if (frame.index == scene.run_frames.last) break;
    }
    return frames;
  }
  std::FILE* const pipe =
      popen(reader_command({"frames", scene.run, range_text(scene.run_frames)}).c_str(), "r");
  if (pipe == nullptr) throw Error(scene.run + ": cannot be read");
  for (Frame frame; bench::read_frame(pipe, frame);) frames.push_back(frame);
  if (pclose(pipe) != 0) throw Error(scene.run + ": cannot be read");
  return frames;
}

/// Throws Error if the source ends before the last frame.
std::vector<Frame> frames_of(const Scene& scene) {
  std::vector<Frame> frames = read_frames(scene);
  const auto expected = static_cast<std::size_t>(scene.run_frames.last - scene.run_frames.first + 1);
  if (frames.size() != expected)
    throw Error(scene.run + ": has " + std::to_string(frames.size()) + " of the " + std::to_string(expected) +
                " frames " + range_text(scene.run_frames) + " that scene " + scene.name + " needs");
  return frames;
}

/// Measures the wall-clock time, us, that OpenGL needs per 1,000 triangles of the whole map, from the frames'
/// poses.
void measure_reference(const SavedMap& map, const std::vector<Frame>& frames, test::Times& us_per_1000) {
  GlContext context;
  GpuMesh mesh(context);
  mesh.upload(map.mesh, MeshUsage::kStatic);
  DepthPass pass(context, {.renderer = DepthRenderer::kOpenGl});
  DepthImage depth_m;
  const MeshInstance room{&mesh, Eigen::Isometry3d::Identity()};
  for (std::size_t i = 0; i < frames.size(); i += 5) {
    if (!frames[i].T_world_camera) continue;
    const Eigen::Isometry3d T_world_camera = map.info.T_world_recorded * *frames[i].T_world_camera;
    const auto start = std::chrono::steady_clock::now();
    const std::size_t drawn = pass.render({&room, 1}, frames[i].depth_camera, T_world_camera, depth_m);
    if (i > 0 && drawn > 0)
      us_per_1000.samples_ms.push_back(1e6 * ms_since(start) / static_cast<double>(drawn));
  }
}

nlohmann::json to_json(const StageSummary& summary) {
  return {{"count", summary.count},
          {"median_ms", summary.median_ms},
          {"p95_ms", summary.p95_ms},
          {"p99_ms", summary.p99_ms},
          {"max_ms", summary.max_ms}};
}

double median(const test::Times& times) { return times.percentile(0.5); }

void drop_if_due(Session& session, int frame) {
  if (frame % kDropEvery != 0) return;
  apply(session, {DropObject{.name = "object", .height_m = kDropHeight_m}});
}

nlohmann::json bench(const Scene& scene, const SavedMap& map, const std::vector<Frame>& frames,
                     const Mesh& object, double slow_ms) {
  test::Times reference_us;
  measure_reference(map, frames, reference_us);

  StageTimes warm_up, times;
  test::Times apart_m, turned_deg, cpu_ms;
  double moved = 0.0, valid = 0.0, deepest_m = 0.0, static_triangles = 0.0;
  int located = 0, contacts = 0;
  std::vector<std::pair<Eigen::Isometry3d, Eigen::Isometry3d>> poses;  // from the source, and estimated
  std::string renderer;
  {
    SessionConfig config;
    config.measure_penetration = true;
    Session session(map, config);
    renderer = session.renderer();
    session.add_object("object", object);
    int number = 0;
    std::map<std::string, std::size_t> counts_so_far;
    for (const Frame& frame : frames) {
      drop_if_due(session, number);
      const bool counts = number++ >= kWarmUpFrames;
      const double cpu_before_ms = process_cpu_ms();
      const FrameResult result = session.step(frame, counts ? times : warm_up);
      if (counts) cpu_ms.samples_ms.push_back(process_cpu_ms() - cpu_before_ms);
      if (counts) say_if_slow(slow_ms, number - 1, times, counts_so_far);
      if (!counts || result.status != FrameStatus::kDone) continue;
      ++located;
      contacts += result.contacts;
      moved += static_cast<double>(result.foreground.moved);
      valid += static_cast<double>(result.foreground.valid);
      deepest_m = std::max(deepest_m, result.deepest_penetration_m);
      static_triangles += static_cast<double>(result.static_triangles_drawn);
      if (!frame.T_world_camera) continue;
      poses.push_back({*frame.T_world_camera, result.T_world_camera});
      if (poses.size() <= kMotionFrames) continue;
      const auto& before = poses[poses.size() - 1 - kMotionFrames];
      const Eigen::Isometry3d T_true_found = (before.first.inverse() * poses.back().first).inverse() *
                                             (before.second.inverse() * poses.back().second);
      apart_m.samples_ms.push_back(T_true_found.translation().norm());
      turned_deg.samples_ms.push_back(Eigen::AngleAxisd(T_true_found.linear()).angle() * 180.0 / M_PI);
    }
  }
  measure_reference(map, frames, reference_us);

  nlohmann::json stages = nlohmann::json::object();
  for (const auto& [stage, summary] : times.summaries()) stages[stage] = to_json(summary);
  const auto frame = stages.find("frame"), contact = stages.find("contact");
  const auto of = [](const auto& found, const char* key, const auto& end) {
    return found == end ? 0.0 : found->at(key).template get<double>();
  };
  return {{"scene", scene.name},
          {"scene_triangles", map.mesh.triangles.size()},
          {"object_triangles", object.triangles.size()},
          {"renderer", renderer},
          {"frames", cpu_ms.samples_ms.size()},
          {"located", located},
          {"median_ms", of(frame, "median_ms", stages.end())},
          {"p95_ms", of(frame, "p95_ms", stages.end())},
          {"p99_ms", of(frame, "p99_ms", stages.end())},
          {"contact_median_ms", of(contact, "median_ms", stages.end())},
          {"contact_p95_ms", of(contact, "p95_ms", stages.end())},
          {"cpu_median_ms", median(cpu_ms)},
          {"stages", stages},
          {"motion_error_median_m", median(apart_m)},
          {"motion_error_p95_m", apart_m.percentile(0.95)},
          {"motion_error_median_deg", median(turned_deg)},
          {"moved_fraction", valid > 0.0 ? moved / valid : 0.0},
          {"contacts", contacts},
          {"deepest_penetration_m", deepest_m},
          {"static_triangles_drawn", located > 0 ? static_triangles / located : 0.0},
          {"reference_us_per_1000_triangles", median(reference_us)}};
}

void print_row(const nlohmann::json& row) {
  const auto number = [&](const char* key) { return row[key].get<double>(); };
  const auto stage = [&](const char* name) {
    return row["stages"].contains(name) ? row["stages"][name]["median_ms"].get<double>() : 0.0;
  };
  std::printf(
      "%-8s %7.0f %7.0f | %7.2f %7.2f %7.2f | %7.2f %7.2f | %7.2f %6.1f | "
      "%6.2f %6.2f %6.2f %6.2f %6.2f %6.2f | %6.1f %6.3f %8.4f %6.2f %5.0f\n",
      row["scene"].get<std::string>().c_str(), number("scene_triangles"), number("object_triangles"),
      number("median_ms"), number("p95_ms"), number("p99_ms"), number("contact_median_ms"),
      number("contact_p95_ms"), number("cpu_median_ms"), number("reference_us_per_1000_triangles"),
      stage("locate"), stage("expected"), stage("foreground"), stage("mesh"), stage("radar"),
      stage("compose"), 1e3 * number("motion_error_median_m"), number("motion_error_median_deg"),
      100.0 * number("moved_fraction"), 1e3 * number("deepest_penetration_m"), number("located"));
  std::fflush(stdout);
}

/// Ratio of frame times with the finest and the coarsest object. Two sessions alternate frame by frame, so
/// temporary slowdowns of the machine affect both.
nlohmann::json ratio_row(const Scene& scene, const SavedMap& map, const std::vector<Frame>& frames,
                         const Mesh& few, const Mesh& many) {
  struct Player {
    std::unique_ptr<Session> session;
    StageTimes times;
    test::Times cpu_ms;
  };
  std::array<Player, 2> players;
  for (std::size_t i = 0; i < players.size(); ++i) {
    players[i].session = std::make_unique<Session>(map, SessionConfig{});
    players[i].session->add_object("object", i == 0 ? few : many);
  }
  int number = 0;
  for (const Frame& frame : frames) {
    for (Player& player : players) {
      player.session->make_current();
      drop_if_due(*player.session, number);
      StageTimes warming_up;
      const double cpu_before_ms = process_cpu_ms();
      (void)player.session->step(frame, number < kWarmUpFrames ? warming_up : player.times);
      if (number >= kWarmUpFrames) player.cpu_ms.samples_ms.push_back(process_cpu_ms() - cpu_before_ms);
    }
    ++number;
  }
  for (Player& player : players) {
    player.session->make_current();
    player.session.reset();
  }
  const auto few_ms = players[0].times.summaries(), many_ms = players[1].times.summaries();
  nlohmann::json more_ms = nlohmann::json::object();
  for (const auto& [stage, summary] : many_ms)
    if (few_ms.contains(stage)) more_ms[stage] = summary.median_ms - few_ms.at(stage).median_ms;
  return {{"scene", scene.name},
          {"work", "frame of most : fewest object triangles"},
          {"median_ratio", many_ms.at("frame").median_ms / few_ms.at("frame").median_ms},
          {"cpu_ratio", median(players[1].cpu_ms) / median(players[0].cpu_ms)},
          {"more_ms", more_ms}};
}

std::optional<Settings> read_arguments(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; i += 2) {
    if (i + 1 == argc) return std::nullopt;
    const std::string key = argv[i], value = argv[i + 1];
    if (key == "--scene")
      settings.scenes.push_back(value);
    else if (key == "--object")
      settings.objects.push_back(std::strtoul(value.c_str(), nullptr, 10));
    else if (key == "--maps")
      settings.maps = value;
    else if (key == "--json")
      settings.json = value;
    else if (key == "--slow")
      settings.slow_ms = std::atof(value.c_str());
    else
      return std::nullopt;
  }
  return settings;
}

template <typename Value>
bool is_wanted(const std::vector<Value>& wanted, const Value& value) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), value) != wanted.end();
}

int run(int argc, char** argv) {
  const std::optional<Settings> asked = read_arguments(argc, argv);
  if (!asked) {
    std::fprintf(
        stderr,
        "usage: frame_bench [--scene kitchen|room|walk]... [--object 12|6256|181412]... [--maps FOLDER] "
        "[--json FILE] [--slow MS]\n");
    return 2;
  }
  const Settings& settings = *asked;
  std::vector<Mesh> objects = {bench::torus_sized_box().mesh};
  for (bench::Sensor& sensor : bench::sensors())
    if (sensor.mesh.triangles.size() > 12) objects.push_back(std::move(sensor.mesh));
  std::erase_if(objects,
                [&](const Mesh& object) { return !is_wanted(settings.objects, object.triangles.size()); });

  std::printf("compiler %s, flags %s\n", __VERSION__, ROOMRADAR_FLAGS);
  std::printf(
      "median ms of stages; frame, p95, p99; contact: depth handed over to contact known; cpu: of all "
      "threads; ref: us for 1,000 triangles with OpenGL; pose error mm and deg against the source's "
      "poses; %% moved; mm deepest overlap; frames located\n"
      "scene       room  object |   frame     p95     p99 | contact     p95 |     cpu    ref | "
      "locate expect foregr   mesh  radar compos |     mm    deg  %% moved  deep   loc\n");
  nlohmann::json rows = nlohmann::json::array();
  for (const Scene& scene : scenes()) {
    if (!is_wanted(settings.scenes, scene.name)) continue;
    const SavedMap map = map_of(scene, settings.maps);
    const std::vector<Frame> frames = frames_of(scene);
    for (const Mesh& object : objects) {
      rows.push_back(bench(scene, map, frames, object, settings.slow_ms));
      print_row(rows.back());
    }
    if (objects.size() < 2) continue;
    rows.push_back(ratio_row(scene, map, frames, objects.front(), objects.back()));
    std::printf("%s: most : fewest triangles of the object: %.2f of the median frame, %.2f of its cpu\n",
                scene.name.c_str(), rows.back()["median_ratio"].get<double>(),
                rows.back()["cpu_ratio"].get<double>());
  }
  test::write_rows(settings.json, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("frame_bench", [&] { return roomradar::run(argc, argv); });
}
