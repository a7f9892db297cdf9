// soak_bench.cpp: hours of simulated play at the Kinect's frame rate, run as fast as possible. Shows growth
// of memory, slowdown and drift.
//
// usage: soak_bench [--hours H] [--width PIXELS] [--map FOLDER] [--json FILE] H (8) hours at 30 frames per
// second of a simulated dining room with a hand, a hand-held camera and the sensor's noise: the same 4 s
// forwards and backwards, so the camera never jumps. Three objects: one is dropped into view every 10 s, one
// is thrown every 15 s, one stays where it fell. One row per tenth of the time: CPU time per frame (all
// threads), resident memory and accuracy. Scene, seeds and events are fixed: changing them breaks the
// comparison with earlier results.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/cli/report.hpp"
#include "app/objects/virtual_object.hpp"
#include "app/session/script/session_events.hpp"
#include "app/session/session.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/prescan.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/process_memory.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "tests/bench/bench_program.hpp"

namespace roomradar {
namespace {

constexpr std::int64_t kRate_hz = 30;
constexpr std::int64_t kShown = 120;  // frames, then the same backwards
constexpr int kParts = 10;

struct Settings {
  double hours = 8.0;
  int width_px = 96;
  std::filesystem::path map = "soak-bench-map";
  std::string json;
};

SavedMap map_at(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "map.json")) {
    std::fprintf(stderr, "%s: scanning the room\n", folder.c_str());
    SimulatedSource source(parse_sim_spec("sim:table?seed=1&frames=240&width=160&rate=15"));
    PrescanConfig config;
    config.poses = PoseOrigin::kRecorded;
    config.resolution_m = 0.03;
    StageTimes times;
    save_map(folder, prescan(source, config, times).map);
  }
  return load_map(folder);
}

std::vector<Frame> frames_to_and_fro(int width_px) {
  SimulatedSource source(parse_sim_spec("sim:table?seed=7&path=view&moving=hand&frames=" +
                                        std::to_string(kShown) + "&width=" + std::to_string(width_px)));
  std::vector<Frame> frames;
  for (Frame frame; source.next(frame).status == ReadStatus::kFrame;) frames.push_back(frame);
  for (std::size_t i = frames.size() - 1; i-- > 1;) frames.push_back(Frame(frames[i]));
  return frames;
}

void play(Session& session, std::int64_t number) {
  if (number % (10 * kRate_hz) == 60)  // after the lying object has come to rest
    apply(session, {DropObject{.name = "dropped"}});
  if (number % (15 * kRate_hz) == 100)
    apply(session, {ThrowObject{"thrown", {0.2, 0.1, 1.4}, {-1.0, 0.5, 1.0}, {3.0, -2.0, 1.0}}});
}

/// Results of one stretch of time.
struct Part {
  std::int64_t frames = 0, located = 0;
  double worst_pose_m = 0.0, deepest_m = 0.0;
};

nlohmann::json row_of(const Part& part, double hours, double cpu_ms, const StageTimes& times) {
  const auto summaries = times.summaries();
  const StageSummary frame = summaries.contains("frame") ? summaries.at("frame") : StageSummary{};
  return {{"until_h", hours},
          {"frames", part.frames},
          {"located", part.located},
          {"cpu_ms", cpu_ms / static_cast<double>(part.frames)},
          {"median_ms", frame.median_ms},
          {"p99_ms", frame.p99_ms},
          {"resident_mb", static_cast<double>(resident_bytes()) / 1e6},
          {"worst_pose_error_m", part.worst_pose_m},
          {"deepest_penetration_m", part.deepest_m}};
}

Settings read_arguments(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 == argc) throw Error(key + ": has no value");
    if (key == "--hours")
      settings.hours = std::clamp(std::atof(argv[i + 1]), 0.01, 1000.0);
    else if (key == "--width")
      settings.width_px = std::clamp(std::atoi(argv[i + 1]), 64, 1920);
    else if (key == "--map")
      settings.map = argv[i + 1];
    else if (key == "--json")
      settings.json = argv[i + 1];
    else
      throw Error(key + ": is not known; use --hours, --width, --map, --json");
  }
  return settings;
}

int soak(const Settings& settings) {
  const SavedMap map = map_at(settings.map);
  const std::vector<Frame> shown = frames_to_and_fro(settings.width_px);
  SessionConfig config;
  config.measure_penetration = true;
  Session session(map, config);
  session.add_object("dropped", object_mesh("teapot", 0.2));
  session.add_object("thrown", object_mesh("teapot", 0.2));
  session.add_object("lies", object_mesh("teapot", 0.2));
  apply(session, {DropObject{.name = "lies"}});

  const auto frames = static_cast<std::int64_t>(settings.hours * 3600.0) * kRate_hz;
  nlohmann::json rows = nlohmann::json::array();
  StageTimes times;
  Part part;
  double cpu_before_ms = process_cpu_ms();
  Frame frame;
  std::printf("%8s %9s %9s %8s %10s %8s %8s %12s %11s\n", "hours", "frames", "located", "cpu ms", "median ms",
              "p99 ms", "MB", "pose err mm", "deepest mm");
  for (std::int64_t i = 0; i < frames; ++i) {
    frame = shown[static_cast<std::size_t>(i) % shown.size()];
    frame.index = i;
    frame.stamp_s = static_cast<double>(i) / static_cast<double>(kRate_hz);
    play(session, i);
    const FrameResult result = session.step(frame, times);
    ++part.frames;
    if (result.status == FrameStatus::kDone) {
      ++part.located;
      const Eigen::Isometry3d T_world_camera = map.info.T_world_recorded * *frame.T_world_camera;
      part.worst_pose_m = std::max(
          part.worst_pose_m, (T_world_camera.translation() - result.T_world_camera.translation()).norm());
      part.deepest_m = std::max(part.deepest_m, result.deepest_penetration_m);
    }
    if ((i + 1) * kParts / frames == i * kParts / frames) continue;
    const double hours = static_cast<double>(i + 1) / static_cast<double>(3600 * kRate_hz);
    const nlohmann::json row = row_of(part, hours, process_cpu_ms() - cpu_before_ms, times);
    const auto number = [&](const char* key) { return row[key].get<double>(); };
    std::printf("%8.2f %9.0f %9.0f %8.3f %10.3f %8.3f %8.2f %12.3f %11.4f\n", number("until_h"),
                number("frames"), number("located"), number("cpu_ms"), number("median_ms"), number("p99_ms"),
                number("resident_mb"), 1e3 * number("worst_pose_error_m"),
                1e3 * number("deepest_penetration_m"));
    std::fflush(stdout);
    rows.push_back(row);
    for (const auto& [stage, summary] : times.summaries())
      rows.back()["stages"][stage] = {{"median_ms", summary.median_ms}, {"p99_ms", summary.p99_ms}};
    part = {};
    times = {};
    cpu_before_ms = process_cpu_ms();
  }
  if (rows.size() > 1) {
    const auto ratio = [&](const char* key) {
      return rows.back()[key].get<double>() / rows.front()[key].get<double>();
    };
    std::printf("last tenth over the first: memory %.4f, processor time a frame %.3f\n", ratio("resident_mb"),
                ratio("cpu_ms"));
  }
  test::write_rows(settings.json, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("soak_bench",
                                     [&] { return roomradar::soak(roomradar::read_arguments(argc, argv)); });
}
