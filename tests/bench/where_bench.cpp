// where_bench.cpp: how well a camera is localised in a saved map, and tracked in it.
//
// usage: where_bench --maps FOLDER [--views N] [--view-seed N] [--random FROM,TO] [--only WORD]
//                    [--pictures FOLDER] [--json FILE]
//        Maps are scanned once and kept in FOLDER. WORD: part of a row's name. --random: random rooms of
//        these seeds instead of the four rooms. --view-seed: other views, to check choices that were made on
//        the default ones.
//
//   found   frames for which a pose is returned
//   right   found within 5 cm and 5 degrees of the truth
//   wrong   the other found frames
//   failed  reasons why frames were not found, and the poses tried
//   ms      time per frame localised without a previous pose; thread: CPU time of the thread
//
// Kitchen: frames 400 to 499 in the map of 0 to 399; recorded poses are the truth. Rooms: random views in
// simulated rooms, see where_bench_rooms.hpp. Settings are those of `run`: changing them breaks the
// comparison with earlier results.
#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/cli/open_source.hpp"
#include "app/media/picture_file.hpp"
#include "app/sim/room/room.hpp"
#include "app/sim/sensor/camera_path.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "app/sources/recordings/recording_writer.hpp"
#include "bench_times.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/trajectory.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/support/recordings.hpp"
#include "where_bench_rooms.hpp"

namespace roomradar {
namespace {

struct RoomSeed {
  std::string name, kind;
  std::uint64_t seed;
};

struct Settings {
  std::filesystem::path maps;
  std::size_t views = 50;
  std::uint64_t view_seed = 1;
  std::vector<RoomSeed> rooms{
      {"table", "table", 1}, {"shelf", "shelf", 1}, {"random2", "random", 2}, {"random3", "random", 3}};
  std::string only, json, pictures;
};

using Eigen::Vector3d;

/// Puts a ball into the frame, as the sensor would measure it; returns the number of pixels it covers.
int put_ball(const Vector3d& centre_camera, double radius_m, Frame& frame) {
  int covered = 0;
  for (int y = 0; y < frame.depth_m.height; ++y) {
    for (int x = 0; x < frame.depth_m.width; ++x) {
      const Vector3d ray = back_project(frame.depth_camera, x, y, 1.0);
      const double along = ray.dot(centre_camera), a = ray.squaredNorm();
      const double inside = along * along - a * (centre_camera.squaredNorm() - radius_m * radius_m);
      if (inside < 0.0) continue;
      const auto depth_m = static_cast<float>((along - std::sqrt(inside)) / a);
      float& measured_m = frame.depth_m.at(x, y);
      ++covered;
      const auto pixel = static_cast<std::uint64_t>(frame.depth_m.index(x, y));
      const float noise = gaussian(hash_of(static_cast<std::uint64_t>(frame.index), pixel));
      measured_m = depth_m + depth_sigma_m(DepthNoise{}, depth_m) * noise;
      if (frame.colour.width == frame.depth_m.width)
        frame.colour.at(x, y) = {static_cast<std::uint8_t>(120.0 + 100.0 * std::sqrt(inside) / radius_m), 90,
                                 40};
    }
  }
  return covered;
}

/// Processes one frame like the command `run`: localises it, then marks its foreground for the next frame.
Tracking step(SearchedRoom& mapped, Locator& locator, const Frame& frame, test::Times& locate_ms) {
  const double start_ms = test::thread_ms(), drawn_ms = mapped.drawing_ms;
  const Tracking tracking = mapped.find(locator, frame, mapped.scene.foreground().dynamic_mask);
  locate_ms.samples_ms.push_back(test::thread_ms() - start_ms - (mapped.drawing_ms - drawn_ms));
  if (has_pose(tracking))
    mapped.scene.find_dynamic(frame,
                              mapped.scene.render_expected(frame.depth_camera, tracking.T_world_camera));
  return tracking;
}

/// Tracks a hand-held camera while a large ball swings in front of it and a person and a hand move about.
/// Measures position error in the map and after the best rigid alignment (ATE), frames lost, and the fraction
/// of the view that moves.
nlohmann::json follow_behind_ball(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                                  std::int64_t frames) {
  SimOptions options = scan;
  options.path = CameraPathKind::kView;
  options.frames = frames;
  options.rate_hz = 30.0;
  options.movers = {MoverKind::kPerson, MoverKind::kHand};
  SimulatedSource source(options);
  Locator locator;
  Frame frame;
  test::Times locate_ms;
  std::vector<TimedPose> truth, estimate;
  double squares = 0.0, moving = 0.0;
  const double drawn_ms = mapped.drawing_ms;
  while (source.next(frame).status == ReadStatus::kFrame) {
    const double swing = std::sin(2.0 * std::numbers::pi * 0.4 * frame.stamp_s);
    if (frame.index > 0) put_ball({0.2 * swing, 0.05 - 0.05 * swing, 0.85 + 0.1 * swing}, 0.27, frame);
    int nearer = 0;  // pixels nearer than the room
    for (std::size_t i = 0; i < frame.depth_m.pixels.size(); ++i)
      nearer += source.truth().moved.pixels[i] != 0 ||
                (frame.depth_m.pixels[i] > 0.0F &&
                 frame.depth_m.pixels[i] < source.truth().depth_m.pixels[i] - 0.1F);
    moving += static_cast<double>(nearer) / static_cast<double>(frame.depth_m.pixels.size());
    const Tracking tracking = step(mapped, locator, frame, locate_ms);
    const Eigen::Isometry3d T_world_true = mapped.map.info.T_world_recorded * *frame.T_world_camera;
    truth.push_back({frame.index, frame.stamp_s, T_world_true});
    if (!has_pose(tracking)) continue;
    estimate.push_back({frame.index, frame.stamp_s, tracking.T_world_camera});
    squares += (tracking.T_world_camera.translation() - T_world_true.translation()).squaredNorm();
  }
  const TrajectoryError ate = absolute_trajectory_error(estimate, truth);
  return {{"row", name},
          {"frames", frames},
          {"located", estimate.size()},
          {"moving_mean", moving / static_cast<double>(frames)},
          {"ate_rmse_mm", 1e3 * ate.rmse_m},
          {"ate_max_mm", 1e3 * ate.max_m},
          {"in_map_rmse_mm",
           1e3 * std::sqrt(squares / static_cast<double>(std::max<std::size_t>(estimate.size(), 1)))},
          {"thread_median_ms", locate_ms.percentile(0.5)},
          {"drawing_mean_ms", (mapped.drawing_ms - drawn_ms) / static_cast<double>(frames)}};
}

/// Tracks a stationary camera; measures the jitter of its pose.
nlohmann::json stand_still(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                           std::int64_t frames) {
  SimOptions options = scan;
  options.path = CameraPathKind::kView;
  SimulatedSource source(options);
  Locator locator;
  Frame frame;
  test::Times locate_ms;
  (void)source.next(frame);
  const Eigen::Isometry3d T_room_camera = *frame.T_world_camera;
  const Eigen::Isometry3d T_world_true = mapped.map.info.T_world_recorded * T_room_camera;
  std::int64_t located = 0;
  std::vector<Eigen::Matrix<double, 6, 1>> errors;  // errors after the first four frames
  for (std::int64_t i = 0; i < frames; ++i) {
    source.look(i, T_room_camera, frame);
    const Tracking tracking = step(mapped, locator, frame, locate_ms);
    if (!has_pose(tracking)) continue;
    ++located;
    if (i > 3) errors.push_back(local(T_world_true.inverse() * tracking.T_world_camera));
  }
  Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
  for (const auto& error : errors) mean += error / static_cast<double>(errors.size());
  double shake_m2 = 0.0, shake_rad2 = 0.0;
  for (const auto& error : errors) {
    shake_m2 += (error - mean).head<3>().squaredNorm() / static_cast<double>(errors.size());
    shake_rad2 += (error - mean).tail<3>().squaredNorm() / static_cast<double>(errors.size());
  }
  const auto none_if_empty = [&](double value) {
    return errors.empty() ? nlohmann::json() : nlohmann::json(value);
  };
  return {{"row", name},
          {"frames", frames},
          {"located", located},
          {"off_mm", none_if_empty(1e3 * mean.head<3>().norm())},
          {"shake_mm", none_if_empty(1e3 * std::sqrt(shake_m2))},
          {"shake_deg", none_if_empty(std::sqrt(shake_rad2) * 180.0 / std::numbers::pi)},
          {"thread_median_ms", locate_ms.percentile(0.5)}};
}

/// Moves the camera elsewhere every 15 frames, every other time after two black frames. Counts the frames
/// until the pose is correct again, and how many of those had a wrong pose.
nlohmann::json carry_away(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                          std::int64_t jumps) {
  constexpr int kStay_frames = 15, kBlack_frames = 2;
  SimulatedSource source(scan);
  const std::vector<Eigen::Isometry3d> stops =
      draw_free_views(source.room(), mapped.map, poses_of(scan), static_cast<std::size_t>(jumps), 9);
  Locator locator;
  Frame frame;
  test::Times locate_ms;
  int longest = 0, wrong = 0, never = 0, frames = 0;
  std::int64_t index = 0;
  for (std::size_t k = 0; k < stops.size(); ++k) {
    const Eigen::Isometry3d T_world_true = mapped.map.info.T_world_recorded * stops[k];
    int until_right = -1;
    for (int i = 0; i < kStay_frames; ++i, ++frames) {
      source.look(index++, stops[k], frame);
      if (k % 2 == 1 && i < kBlack_frames) {
        frame.depth_m.resize(frame.depth_m.width, frame.depth_m.height);
        frame.colour.resize(frame.colour.width, frame.colour.height);
      }
      const Tracking tracking = step(mapped, locator, frame, locate_ms);
      const bool is_right =
          has_pose(tracking) &&
          (tracking.T_world_camera.translation() - T_world_true.translation()).norm() < 0.05;
      wrong += has_pose(tracking) && !is_right;
      if (is_right && until_right < 0) until_right = i - (k % 2 == 1 ? kBlack_frames : 0);
    }
    never += until_right < 0;
    longest = std::max(longest, until_right);
  }
  return {{"row", name},    {"jumps", stops.size()},     {"frames", frames},
          {"never", never}, {"longest_frames", longest}, {"wrong_frames", wrong}};
}

/// Lists the pose hypotheses of a search, their errors, and the evidence for each.
nlohmann::json tried(const Locator& locator, const Eigen::Isometry3d& truth) {
  nlohmann::json poses = nlohmann::json::array();
  for (const PoseHypothesis& hypothesis : locator.hypotheses) {
    const Eigen::Isometry3d gap = truth.inverse() * hypothesis.tracking.T_world_camera;
    poses.push_back({{"status", to_string(hypothesis.tracking.status)},
                     {"m", gap.translation().norm()},
                     {"deg", Eigen::AngleAxisd(gap.linear()).angle() * 180.0 / std::numbers::pi},
                     {"patches_compared", hypothesis.appearance.compared},
                     {"patches_alike", hypothesis.appearance.alike.size()},
                     {"depth_both", static_cast<double>(hypothesis.agreement.both) /
                                        std::max(hypothesis.agreement.valid, 1)},
                     {"depth_alike", hypothesis.agreement.alike_part()},
                     {"depth_farther", hypothesis.agreement.farther_part()},
                     {"uncertainty_m", std::min(hypothesis.uncertainty_m, 1e3)}});
  }
  return poses;
}

/// Localises each frame of the source without a previous pose.
nlohmann::json find_all(const std::string& name, FrameSource& source, SearchedRoom& mapped,
                        const Settings& settings) {
  Frame frame;
  test::Times wall, thread;
  std::vector<double> errors_mm;
  int asked = 0, found = 0, right = 0;
  Locator fresh;
  fresh.index.patches = build_patch_index(mapped.map.keyframe_database.load());
  nlohmann::json failed = nlohmann::json::array();
  for (ReadResult read; (read = source.next(frame)).status != ReadStatus::kEnd;) {
    ++asked;
    if (read.status == ReadStatus::kSkipped) continue;  // a requested frame that is not found
    Locator locator = fresh;
    const auto start = std::chrono::steady_clock::now();
    const double thread_start_ms = test::thread_ms();
    const Tracking tracking = mapped.find(locator, frame);
    thread.samples_ms.push_back(test::thread_ms() - thread_start_ms);
    wall.samples_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    const bool is_found = has_pose(tracking);
    const Eigen::Isometry3d truth = mapped.map.info.T_world_recorded * *frame.T_world_camera;
    const Eigen::Isometry3d error = truth.inverse() * tracking.T_world_camera;
    const double error_m = error.translation().norm();
    const double error_deg = Eigen::AngleAxisd(error.linear()).angle() * 180.0 / std::numbers::pi;
    const bool is_right = is_found && error_m < 0.05 && error_deg < 5.0;
    found += is_found, right += is_right;
    if (is_found) errors_mm.push_back(1e3 * error_m);
    if (is_right) continue;
    failed.push_back({{"frame", frame.index},
                      {"found", is_found},
                      {"m", error_m},
                      {"deg", error_deg},
                      {"why", to_string(locator.search_end)},
                      {"tried", tried(locator, truth)}});
    if (settings.pictures.empty()) continue;
    std::filesystem::create_directories(settings.pictures);
    write_png(frame.colour,
              std::filesystem::path(settings.pictures) /
                  (name + "-" + std::to_string(frame.index) + (is_found ? "-wrong" : "") + ".png"));
  }
  std::sort(errors_mm.begin(), errors_mm.end());
  return {{"row", name},
          {"keyframes", mapped.map.keyframe_database.load().keyframes.size()},
          {"asked", asked},
          {"found", found},
          {"right", right},
          {"wrong", found - right},
          {"error_median_mm", errors_mm.empty() ? -1.0 : errors_mm[errors_mm.size() / 2]},
          {"median_ms", wall.percentile(0.5)},
          {"p95_ms", wall.percentile(0.95)},
          {"thread_median_ms", thread.percentile(0.5)},
          {"failed", failed}};
}

/// Random views of a simulated room, as a recording that is saved beside the maps.
std::unique_ptr<FrameSource> free_views(const SimOptions& scan, const SavedMap& map,
                                        const std::vector<MoverKind>& movers, bool bare,
                                        const std::string& name, const Settings& settings) {
  const std::filesystem::path folder =
      settings.maps / ("views-" + name + "-" + std::to_string(settings.views) +
                       (settings.view_seed == 1 ? "" : "-of-seed-" + std::to_string(settings.view_seed)));
  if (!std::filesystem::exists(folder / "groundtruth.txt")) {
    SimOptions options = scan;
    options.movers = movers;
    SimulatedSource source(options);
    const std::filesystem::path unfinished = folder.string() + ".unfinished";
    std::filesystem::remove_all(unfinished);
    RecordingWriter writer(unfinished, RecordingFormat::kTum);
    Frame frame;
    std::int64_t index = 0;
    for (const Eigen::Isometry3d& T_room_camera : draw_free_views(
             source.room(), map, poses_of(scan), settings.views, settings.view_seed, {.bare = bare})) {
      source.look(5 * index++, T_room_camera, frame);
      writer.write(frame);
    }
    writer.close();
    std::filesystem::rename(unfinished, folder);
  }
  return open_folder(folder);
}

/// Parses "4,7" as the random rooms with seeds 4 to 7.
std::vector<RoomSeed> random_rooms(const std::string& from_to) {
  std::uint64_t from = 0, to = 0;
  if (std::sscanf(from_to.c_str(), "%" SCNu64 ",%" SCNu64, &from, &to) != 2 || from > to)
    throw std::runtime_error("--random " + from_to + ": two seeds, FROM,TO, are needed");
  std::vector<RoomSeed> rooms;
  for (std::uint64_t seed = from; seed <= to; ++seed)
    rooms.push_back({"random" + std::to_string(seed), "random", seed});
  return rooms;
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string word = argv[i], value = argv[i + 1];
    if (word == "--maps") settings.maps = value;
    if (word == "--views") settings.views = static_cast<std::size_t>(std::atoll(value.c_str()));
    if (word == "--view-seed") settings.view_seed = static_cast<std::uint64_t>(std::atoll(value.c_str()));
    if (word == "--random") settings.rooms = random_rooms(value);
    if (word == "--only") settings.only = value;
    if (word == "--pictures") settings.pictures = value;
    if (word == "--json") settings.json = value;
  }
  return settings;
}

nlohmann::json bench(const Settings& settings) {
  nlohmann::json rows = nlohmann::json::array();
  const auto add = [&](const std::string& name, const std::function<nlohmann::json()>& row) {
    if (name.find(settings.only) == std::string::npos) return;
    rows.push_back(row());
    std::printf("%s\n", rows.back().dump().c_str());
    std::fflush(stdout);
  };
  const std::string kitchen = test::recording("kitchen").value_or("kitchen").string();
  add("kitchen", [&] {
    SearchedRoom mapped(
        map_of(*open_source(kitchen, FrameRange{0, 399}), PoseOrigin::kRecorded, settings.maps / "kitchen"));
    return find_all("kitchen", *open_source(kitchen, FrameRange{400, 499}), mapped, settings);
  });
  for (const RoomSeed& room : settings.rooms) {
    const SimOptions scan = scan_of(room.kind, room.seed);
    const auto scan_map = [&] {
      SimulatedSource source(scan);
      return map_of(source, PoseOrigin::kTracked, settings.maps / room.name);
    };
    for (const char* what : {"", "-people", "-bare"}) {
      const std::string name = room.name + what;
      add(name, [&] {
        SearchedRoom mapped(scan_map());
        const std::vector<MoverKind> movers = std::string(what) == "-people"
                                                  ? std::vector{MoverKind::kPerson, MoverKind::kHand}
                                                  : std::vector<MoverKind>{};
        return find_all(name,
                        *free_views(scan, mapped.map, movers, std::string(what) == "-bare", name, settings),
                        mapped, settings);
      });
    }
    const auto on_map = [&](const char* what, const auto& row) {
      add(room.name + what, [&] {
        SearchedRoom mapped(scan_map());
        return row(room.name + what, scan, mapped, static_cast<std::int64_t>(settings.views));
      });
    };
    on_map("-ball", [](const auto& name, const auto& of, auto& mapped, std::int64_t views) {
      return follow_behind_ball(name, of, mapped, 3 * views);
    });
    on_map("-still", [](const auto& name, const auto& of, auto& mapped, std::int64_t views) {
      return stand_still(name, of, mapped, 2 * views);
    });
    on_map("-carried", [](const auto& name, const auto& of, auto& mapped, std::int64_t views) {
      return carry_away(name, of, mapped, views / 5);
    });
  }
  return rows;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("where_bench", [&] {
    const roomradar::Settings settings = roomradar::parse(argc, argv);
    if (settings.maps.empty()) {
      std::fprintf(
          stderr,
          "usage: where_bench --maps FOLDER [--views N] [--view-seed N] [--random FROM,TO] [--only WORD]\n"
          "                   [--pictures FOLDER] [--json FILE]\n");
      return 2;
    }
    const nlohmann::json rows = roomradar::bench(settings);
    roomradar::test::write_rows(settings.json, rows);
    return 0;
  });
}
