// track_bench.cpp: error and time of tracking and of relocalisation, on recordings with known poses.
//
// usage: track_bench [--frames N] [--places N] [--json FILE] [--trajectory FILE] SOURCE...      SOURCE: a
// folder or sim:ROOM?... One row per source: ATE RMSE over all frames, median RPE over 1 and 30 frames, the
// error of the last pose after aligning the first with its true pose, time per frame (wall clock, and CPU
// time of the tracking thread), loops, the memory used by keyframes, the recall of the feature index, and how
// many submaps of 50 frames still move after they are complete.
// With --places N the first N frames, at their recorded poses, become map keyframes, and the later frames are
// localised among them. Settings are the defaults of OdometryConfig: changing them breaks the comparison with
// earlier results.
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/sim/sensor/simulated_source.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/localization/place_matching.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/odometry/odometry.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"
#include "mapping/types/trajectory.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/bench_times.hpp"

namespace roomradar {
namespace {

using Clock = std::chrono::steady_clock;

struct Settings {
  std::int64_t frames = 600;
  std::int64_t keyframe_database = 0;
  std::string json;
  std::string trajectory;
  std::vector<std::string> sources;
};

std::unique_ptr<FrameSource> open(const std::string& name) {
  if (name.starts_with("sim:")) return std::make_unique<SimulatedSource>(parse_sim_spec(name));
  return open_folder(name);
}

double since_ms(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Memory of all images and features that the odometry keeps between frames.
double kept_mb(const OdometrySnapshot& kept) {
  std::size_t bytes = 0;
  for (const Keyframe& keyframe : kept.graph.keyframes) {
    bytes += keyframe.view->columns.size();
  }
  for (const MapKeyframe& place : kept.keyframe_database.keyframes) {
    bytes += 2 * place.preview_depth_mm.pixels.size() +
             (sizeof(Descriptor) + sizeof(Eigen::Vector3f)) * place.descriptors.size();
  }
  return static_cast<double>(bytes) / 1e6;
}

/// Median length, m, of the difference between the motions of both trajectories over `step` frames.
double relative_error_m(const std::vector<TimedPose>& estimate, const std::vector<TimedPose>& truth,
                        std::size_t step) {
  std::vector<double> errors_m;
  for (std::size_t i = 0; i + step < std::min(estimate.size(), truth.size()); ++i) {
    const Eigen::Isometry3d there = truth[i].T_world_camera.inverse() * truth[i + step].T_world_camera;
    const Eigen::Isometry3d found = estimate[i].T_world_camera.inverse() * estimate[i + step].T_world_camera;
    errors_m.push_back((there.inverse() * found).translation().norm());
  }
  return test::quantile(errors_m, 0.5);
}

/// Returns the median time, ms, of the frames in the minute that begins at from_s.
double median_of_minute(const std::vector<double>& times_ms, const std::vector<double>& stamps_s,
                        double from_s) {
  std::vector<double> in_minute_ms;
  for (std::size_t i = 0; i < times_ms.size(); ++i)
    if (stamps_s[i] >= from_s && stamps_s[i] <= from_s + 60.0) in_minute_ms.push_back(times_ms[i]);
  return test::quantile(in_minute_ms, 0.5);
}

/// Of the keyframes for which comparing all features finds a distant keyframe with 25 matches at least, as
/// for closing loops, returns the share for which the index finds one. Samples some 200 keyframes.
double recall_of_index(KeyframeDatabase keyframe_database) {
  constexpr std::size_t kQueries = 200, kCount = 2;
  constexpr int kMinMatches = 25;
  update_index(keyframe_database);
  KeyframeDatabase compare_all{keyframe_database.keyframes, {}};
  const std::size_t count = keyframe_database.keyframes.size(), stride = 1 + count / kQueries;
  std::size_t expected = 0, found = 0;
  for (std::size_t i = 0; i < count; i += stride) {
    const MapKeyframe& query = keyframe_database.keyframes[i];
    const auto is_distant = [&](std::size_t other) {
      return view_distance(keyframe_database.keyframes[other].T_world_camera.inverse() *
                           query.T_world_camera) >= KeyframeGraphConfig{}.furthest;
    };
    const auto all = most_alike(query, compare_all, kCount, kMinMatches, is_distant);
    const auto indexed = most_alike(query, keyframe_database, kCount, kMinMatches, is_distant);
    expected += all.empty() ? 0 : 1;
    found += all.empty() || indexed.empty() ? 0 : 1;
  }
  return expected > 0 ? static_cast<double>(found) / static_cast<double>(expected) : 1.0;
}

constexpr std::size_t kSubmap = 50;  // frames

/// Appends the poses of a submap once as many frames again have been tracked.
void note_submap(const OdometrySnapshot& kept, std::vector<Eigen::Isometry3d>& T_world_noted) {
  if (kept.frames.size() < T_world_noted.size() + 2 * kSubmap) return;
  for (std::size_t i = 0; i < kSubmap; ++i)
    T_world_noted.push_back(T_world_camera_of(kept, kept.frames[T_world_noted.size()]));
}

/// Numbers of submaps. Each counts where any point 2 m in front of a camera has moved by more than 5 mm.
struct SubmapMotion {
  std::size_t all = 0;
  std::size_t moved = 0;  ///< moved between note_submap() and the end
  std::size_t bent = 0;   ///< moved relative to the submap's middle frame
};

SubmapMotion submap_motion(const std::vector<Eigen::Isometry3d>& T_world_noted,
                           const std::vector<TrackedFrame>& frames) {
  constexpr double kMoved_m = 0.005;
  const Eigen::Vector3d ahead_m(0.0, 0.0, 2.0);
  SubmapMotion motion;
  for (std::size_t first = 0; first + kSubmap <= T_world_noted.size(); first += kSubmap) {
    const std::size_t middle = first + kSubmap / 2;
    const Eigen::Isometry3d T_end_noted = frames[middle].T_world_camera * T_world_noted[middle].inverse();
    bool moved = false, bent = false;
    for (std::size_t i = first; i < first + kSubmap; ++i) {
      if (!frames[i].trusted) continue;
      const Eigen::Vector3d end = frames[i].T_world_camera * ahead_m, noted = T_world_noted[i] * ahead_m;
      moved |= (end - noted).norm() > kMoved_m;
      bent |= (end - T_end_noted * noted).norm() > kMoved_m;
    }
    ++motion.all;
    motion.moved += moved ? 1 : 0;
    motion.bent += bent ? 1 : 0;
  }
  return motion;
}

nlohmann::json bench_tracking(const std::string& name, const Settings& settings) {
  const std::unique_ptr<FrameSource> source = open(name);
  OdometryConfig config;
  Odometry odometry(config);
  int restarts = 0;
  Frame frame;
  std::vector<TimedPose> truth;
  std::vector<Eigen::Isometry3d> T_world_noted;
  std::vector<double> times_ms, cpu_ms, stamps_s, residuals_m;
  double inliers = 0.0;
  const std::int64_t last_frame = std::min(settings.frames, source->frame_count().value_or(settings.frames));
  while (odometry.counts().frames < settings.frames) {
    const ReadResult read = source->next(frame);
    if (read.status == ReadStatus::kEnd) break;
    if (read.status == ReadStatus::kSkipped) continue;
    const auto start = Clock::now();
    const double cpu_start_ms = test::thread_ms();
    const Tracking tracking = odometry.track(frame);
    cpu_ms.push_back(test::thread_ms() - cpu_start_ms);
    times_ms.push_back(since_ms(start));
    stamps_s.push_back(frame.stamp_s);
    note_submap(odometry.state(), T_world_noted);
    inliers += tracking.inlier_fraction;
    residuals_m.push_back(tracking.rms_m);
    truth.push_back(
        {frame.index, frame.stamp_s, frame.T_world_camera.value_or(Eigen::Isometry3d::Identity())});
    const bool probed = odometry.counts().frames == std::min<std::int64_t>(kProbeFrames, last_frame);
    if (!probed || restarts == kMostRestarts || !are_times_wrong(odometry.state().timing)) continue;
    ++restarts;
    config.timing = odometry.state().timing.current;
    odometry = Odometry(config);
    truth.clear(), T_world_noted.clear(), times_ms.clear(), cpu_ms.clear(), stamps_s.clear(),
        residuals_m.clear();
    inliers = 0.0;
    source->rewind();
  }
  const auto start = Clock::now();
  std::vector<TimedPose> estimate;
  double furthest_m = 0.0;
  const std::vector<TrackedFrame> frames = odometry.optimise();
  for (const TrackedFrame& f : frames) {
    estimate.push_back({f.frame_index, f.stamp_s, f.T_world_camera});
    furthest_m = std::max(furthest_m, f.T_world_camera.translation().norm());
  }
  const double optimise_ms = since_ms(start);
  if (!settings.trajectory.empty()) write_trajectory(settings.trajectory, estimate);
  const SubmapMotion submaps = submap_motion(T_world_noted, frames);
  const bool known = frame.T_world_camera.has_value();
  const TrajectoryError ate = absolute_trajectory_error(estimate, truth);
  const OdometryCounts counts = odometry.counts();
  const double peak_mb = peak_rss_mb();
  return {{"source", name},
          {"frames", counts.frames},
          {"tracked", counts.tracked},
          {"degenerate", counts.degenerate},
          {"lost", counts.lost},
          {"relocalised", counts.relocalised},
          {"keyframes", counts.keyframes},
          {"loops", counts.loops_found},
          {"loops_rejected", counts.loops_rejected},
          {"ate_rmse_mm", known ? 1e3 * ate.rmse_m : -1.0},
          {"ate_max_mm", known ? 1e3 * ate.max_m : -1.0},
          {"rpe1_median_mm", known ? 1e3 * relative_error_m(estimate, truth, 1) : -1.0},
          {"end_to_start_gap_mm", known ? 1e3 * end_gap_m(estimate, truth) : -1.0},
          {"rpe30_median_mm", known ? 1e3 * relative_error_m(estimate, truth, 30) : -1.0},
          {"furthest_m", furthest_m},
          {"submaps", submaps.all},
          {"submaps_moved", submaps.moved},
          {"submaps_bent", submaps.bent},
          {"inlier_mean", inliers / static_cast<double>(std::max<std::size_t>(times_ms.size(), 1))},
          {"residual_median_mm", 1e3 * test::quantile(residuals_m, 0.5)},
          {"restarts", restarts},
          {"depth_readout_ms", 1e3 * odometry.state().timing.current.depth_readout_s},
          {"colour_readout_ms", 1e3 * odometry.state().timing.current.colour_readout_s},
          {"colour_delay_ms", 1e3 * odometry.state().timing.current.colour_delay_s},
          {"median_ms", test::quantile(times_ms, 0.5)},
          {"p95_ms", test::quantile(times_ms, 0.95)},
          {"thread_median_ms", test::quantile(cpu_ms, 0.5)},
          {"thread_p95_ms", test::quantile(cpu_ms, 0.95)},
          {"thread_max_ms", test::quantile(cpu_ms, 1.0)},
          {"first_minute_median_ms", median_of_minute(times_ms, stamps_s, stamps_s.front())},
          {"last_minute_median_ms", median_of_minute(times_ms, stamps_s, stamps_s.back() - 60.0)},
          {"max_ms", test::quantile(times_ms, 1.0)},
          {"optimise_ms", optimise_ms},
          {"kept_mb", kept_mb(odometry.snapshot())},
          {"peak_rss_mb", peak_mb},
          {"index_recall", recall_of_index(odometry.take_keyframe_database())}};
}

nlohmann::json bench_places(const std::string& name, const Settings& settings) {
  const std::unique_ptr<FrameSource> source = open(name);
  Odometry odometry;
  KeyframeDatabase keyframe_database;
  Frame frame;
  std::vector<double> times_ms, errors_mm;
  int asked = 0, found = 0, right = 0;
  for (std::int64_t count = 0; count < settings.frames;) {
    const ReadResult read = source->next(frame);
    if (read.status == ReadStatus::kEnd) break;
    if (read.status == ReadStatus::kSkipped || !frame.T_world_camera) continue;
    if (count++ < settings.keyframe_database) {
      odometry.add_posed(frame, *frame.T_world_camera);
      continue;
    }
    if (keyframe_database.keyframes.empty()) keyframe_database = odometry.take_keyframe_database();
    ++asked;
    const auto start = Clock::now();
    const Relocalisation answer = relocalise(frame, keyframe_database);
    times_ms.push_back(since_ms(start));
    if (!answer) continue;
    ++found;
    const Eigen::Isometry3d error = frame.T_world_camera->inverse() * answer.T_world_camera;
    errors_mm.push_back(1e3 * error.translation().norm());
    const double angle_deg = Eigen::AngleAxisd(error.linear()).angle() * 180.0 / 3.14159265358979;
    right += error.translation().norm() < 0.05 && angle_deg < 5.0 ? 1 : 0;
  }
  return {{"source", name},
          {"keyframes", keyframe_database.keyframes.size()},
          {"asked", asked},
          {"found", found},
          {"within_5cm_5deg", right},
          {"error_median_mm", test::quantile(errors_mm, 0.5)},
          {"error_max_mm", test::quantile(errors_mm, 1.0)},
          {"median_ms", test::quantile(times_ms, 0.5)},
          {"p95_ms", test::quantile(times_ms, 0.95)}};
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] { return i + 1 < argc ? std::string(argv[++i]) : std::string(); };
    if (word == "--frames") {
      settings.frames = std::atoll(value().c_str());
    } else if (word == "--places") {
      settings.keyframe_database = std::atoll(value().c_str());
    } else if (word == "--json") {
      settings.json = value();
    } else if (word == "--trajectory") {
      settings.trajectory = value();
    } else {
      settings.sources.push_back(word);
    }
  }
  return settings;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("track_bench", [&] {
    const roomradar::Settings settings = roomradar::parse(argc, argv);
    if (settings.sources.empty()) {
      std::fprintf(
          stderr,
          "usage: track_bench [--frames N] [--places N] [--json FILE] [--trajectory FILE] SOURCE...\n");
      return 2;
    }
    nlohmann::json rows = nlohmann::json::array();
    for (const std::string& source : settings.sources) {
      rows.push_back(settings.keyframe_database > 0 ? roomradar::bench_places(source, settings)
                                                    : roomradar::bench_tracking(source, settings));
      std::printf("%s\n", rows.back().dump().c_str());
      std::fflush(stdout);
    }
    roomradar::test::write_rows(settings.json, rows);
    return 0;
  });
}
