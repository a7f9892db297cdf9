// prescan_work.cpp: measures one scan in a child process: time, memory, errors.
#include "app/evaluation/trade/prescan_work.hpp"

#include <cmath>
#include <limits>
#include <memory>

#include "app/cli/apply_scan_quality.hpp"
#include "app/cli/report.hpp"
#include "app/evaluation/held_out.hpp"
#include "app/evaluation/trade/measured_sandboxed.hpp"
#include "app/evaluation/trade/trade_frames.hpp"
#include "app/sim/scenarios/surface_score.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/prescan.hpp"
#include "mapping/types/linear_algebra.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/process_memory.hpp"

namespace roomradar {
namespace {

constexpr std::int64_t kHoldOut = 7;  // coprime with every value of fuse_every
constexpr double kSpacing_m = 0.01;   // between sample points on the mesh

struct ScanScene {
  std::string name;
  std::vector<Frame> frames;
  std::unique_ptr<Room> room;         // null for recordings
  std::vector<Eigen::Vector3d> seen;  // observed points of the room's surface
};

std::vector<FigureName> scan_figures() {
  using Kind = FigureKind;
  return {{"scan_ms_per_frame", "whole scan, ms per frame", 1.0, Kind::kTime},
          {"cpu_ms", "CPU time, all threads, ms per frame", 1.0, Kind::kTime},
          {"track_ms", "track, ms", 1.0, Kind::kTime},
          {"fuse_ms", "fuse, ms", 1.0, Kind::kTime},
          {"surface_ms", "surface, ms", 1.0, Kind::kTime},
          {"memory_mb", "peak memory of the process, MB", 1.0, Kind::kMemory},
          {"octree_mb", "octree, MB", 1.0, Kind::kFact},
          {"triangles", "triangles", 1.0, Kind::kFact},
          {"surface_error_median_m", "surface error, median, mm", 1e3, Kind::kError, 0.0002},
          {"surface_error_p95_m", "surface error, p95, mm", 1e3, Kind::kError, 0.001},
          {"surface_missing", "observed surface missing from the mesh, %", 1e2, Kind::kError, 0.005},
          {"trajectory_error_m", "trajectory error (ATE), mm", 1e3, Kind::kError, 0.001},
          {"frames_lost", "frames lost, %", 1e2, Kind::kError, 0.01}};
}

double median_of(const std::map<std::string, StageSummary>& stages, const char* stage) {
  const auto found = stages.find(stage);
  return found == stages.end() ? kNotMeasured : found->second.median_ms;
}

/// Returns the transform from the map's world frame to the room's: mean rotation and translation over all
/// poses. Positions alone would leave the rotation about a straight path undetermined.
Eigen::Isometry3d T_room_map_of(const std::vector<TimedPose>& trajectory, const std::vector<Frame>& frames) {
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
  for (const TimedPose& pose : trajectory) {
    const Eigen::Isometry3d& T_room_camera =
        *frames[static_cast<std::size_t>(pose.frame_index)].T_world_camera;
    turns += T_room_camera.linear() * pose.T_world_camera.linear().transpose();
  }
  Eigen::Isometry3d T_room_map = Eigen::Isometry3d::Identity();
  T_room_map.linear() = nearest_orthogonal(turns);
  Eigen::Vector3d shifts = Eigen::Vector3d::Zero();
  for (const TimedPose& pose : trajectory)
    shifts += frames[static_cast<std::size_t>(pose.frame_index)].T_world_camera->translation() -
              T_room_map.linear() * pose.T_world_camera.translation();
  T_room_map.translation() = shifts / static_cast<double>(trajectory.size());
  return T_room_map;
}

/// Returns median and p95 of the error, and the missing fraction.
std::array<double, 3> surface_errors(const ScanScene& scene, const PrescanResult& scanned,
                                     FrameSource& source) {
  if (!scene.room) {
    const HeldOutScore score = score_held_out(source, scanned.map.mesh, scanned.map.trajectory, kHoldOut);
    if (score.pixels == 0) return {kNotMeasured, kNotMeasured, kNotMeasured};
    return {score.cover > 0.0 ? score.median_m : kNotMeasured, kNotMeasured, 1.0 - score.cover};
  }
  const SurfaceScore score =
      score_surface(scanned.map.mesh, T_room_map_of(scanned.map.trajectory, scene.frames), *scene.room,
                    scene.seen, kSpacing_m);
  return {score.error_median_m, score.error_p95_m, 1.0 - score.cover};
}

Readings measure(const ScanScene& scene, const Setting& setting) {
  mmap_large_allocations();
  const std::size_t start_bytes = resident_bytes();
  PrescanConfig config;
  apply(scan_quality_of(setting), config);
  if (!scene.room) config.hold_out = kHoldOut;
  KeptFrames source(scene.frames, scene.name);
  StageTimes times;
  const auto start = std::chrono::steady_clock::now();
  const double cpu_before_ms = process_cpu_ms();
  const PrescanResult scanned = prescan(source, config, times);
  const double scan_ms = ms_since(start) - source.spent_ms();
  const double cpu_ms = process_cpu_ms() - cpu_before_ms;
  const double memory_mb = peak_growth_mb(start_bytes);

  const auto stages = times.summaries();
  const auto frames = static_cast<double>(scene.frames.size());
  const PrescanCounts& counts = scanned.counts;
  const auto [median_m, p95_m, missing] = surface_errors(scene, scanned, source);
  return {scan_ms / frames,
          cpu_ms / frames,
          median_of(stages, "track"),
          median_of(stages, "fuse"),
          median_of(stages, "surface"),
          memory_mb,
          static_cast<double>(scanned.map.octree.load().memory_bytes()) / 1e6,
          static_cast<double>(scanned.map.mesh.triangles.size()),
          median_m,
          p95_m,
          missing,
          counts.trajectory_error ? counts.trajectory_error->rmse_m : kNotMeasured,
          static_cast<double>(counts.frames_lost) / frames};
}

std::shared_ptr<const ScanScene> open_room(const std::string& spec, const TradeScale& scale) {
  auto scene = std::make_shared<ScanScene>();
  SimOptions options = parse_sim_spec("sim:" + spec);
  options.frames = scale.scan_frames;
  options.rate_hz = scale.scan_rate_hz;
  options.depth_camera = kinect_of_width(scale.scan_px);
  scene->name = sim_spec(options);
  SimulatedSource source(options);
  SeenSurface seen;
  for (Frame frame; source.next(frame).status == ReadStatus::kFrame;) {
    seen.add(frame, source.truth());
    scene->frames.push_back(frame);
  }
  scene->seen = seen.points();
  scene->room = std::make_unique<Room>(source.room());
  return scene;
}

std::shared_ptr<const ScanScene> open_recording(const std::string& folder, const TradeScale& scale) {
  auto scene = std::make_shared<ScanScene>();
  scene->name = folder;
  scene->frames = frames_of_recording(folder, scale.scan_frames);
  return scene;
}

}  // namespace

std::vector<Parameter> scan_parameters() {
  return {{"resolution_m", {"0.04", "0.028", "0.02", "0.014", "0.01", "0.007"}, 4},
          {"deviation_m", {"0.008", "0.004", "0.002", "0.001", "0.0005"}, 2},
          {"tracking_px", {"160", "320", "640"}, 1},
          {"fuse_every", {"6", "4", "3", "2", "1"}, 4}};
}

ScanQuality scan_quality_of(const Setting& setting) {
  ScanQuality quality;
  const std::vector<Parameter> parameters = scan_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i)
    set_field(quality, parameters[i].name, parameters[i].words[setting[i]]);
  return quality;
}

MeasuredWork prescan_work(const std::vector<std::string>& rooms, const std::vector<std::string>& recordings,
                          const TradeScale& scale) {
  MeasuredWork work{
      .name = "prescan", .parameters = scan_parameters(), .figures = scan_figures(), .scenes = rooms};
  work.scenes.insert(work.scenes.end(), recordings.begin(), recordings.end());
  work.open = [rooms, recordings, scale](std::size_t number) -> Measure {
    const auto scene = number < rooms.size() ? open_room(rooms[number], scale)
                                             : open_recording(recordings[number - rooms.size()], scale);
    return [scene](const Setting& setting) {
      return measured_sandboxed("prescan of " + scene->name, [&] { return measure(*scene, setting); });
    };
  };
  return work;
}

}  // namespace roomradar
