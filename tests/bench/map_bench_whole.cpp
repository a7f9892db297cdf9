// map_bench_whole.cpp: a prescan of one recording, and two maps of it that are judged along held-out rays.
#include "tests/bench/map_bench_whole.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/open_source.hpp"
#include "mapping/map/map_merge.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/bench/bench_times.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test {
namespace {

constexpr int kHeldOut = 20;       // one frame in this many is not fused
constexpr int kPixelStep = 12;     // of the rays judged
constexpr double kBin_m = 0.5;     // of depth
constexpr int kBins = 10;          // up to 5 m
constexpr double kReach_m = 0.15;  // around the true depth

// Calls visit(frame, number) for each frame that has a pose.
template <typename Visit>
void for_frames(const std::string& name, const Visit& visit) {
  const std::unique_ptr<FrameSource> source = open_source(name, {}, "");
  Frame frame;
  for (int number = 0;;) {
    const ReadResult read = source->next(frame);
    if (read.status == ReadStatus::kEnd) return;
    if (read.status == ReadStatus::kFrame && frame.T_world_camera) visit(frame, number++);
  }
}
bool is_held_out(int number) { return number % kHeldOut == kHeldOut / 2; }

struct Fused {
  StaticMap map;
  test::Times times;
};

// Trilinear mean of the known samples among the eight around a point; none if they weigh less than half.
std::optional<double> distance_near(const StaticMap& map, const Eigen::Vector3d& p_world) {
  const double voxel_m = map.resolution_m();
  const Eigen::Vector3d p = p_world / voxel_m - Eigen::Vector3d::Constant(0.5);
  const Eigen::Vector3d low = p.array().floor();
  const Eigen::Vector3d t = p - low;
  double sum = 0.0, weights = 0.0;
  for (unsigned i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner(i & 1U, i >> 1U & 1U, i >> 2U & 1U);
    const double weight = (corner.array() * t.array() + (1.0 - corner.array()) * (1.0 - t.array())).prod();
    const auto sample = map.sample_at((low + corner + Eigen::Vector3d::Constant(0.5)) * voxel_m);
    if (!sample) continue;
    sum += weight * static_cast<double>(sample->distance_m);
    weights += weight;
  }
  return weights < 0.5 ? std::nullopt : std::optional(sum / weights);
}

// Depth of the ray's zero crossing nearest to depth_m, minus depth_m.
std::optional<double> ray_error_m(const StaticMap& map, const Eigen::Isometry3d& T_world_camera,
                                  const Eigen::Vector3d& ray_camera, double depth_m) {
  std::optional<double> nearest, before;
  const double step_m = 0.5 * map.resolution_m();
  for (double z = depth_m - kReach_m; z < depth_m + kReach_m; z += step_m) {
    const auto distance = distance_near(map, T_world_camera * (ray_camera * z));
    if (distance && before && *before > 0.0 && *distance <= 0.0) {
      const double crossing = z - step_m + step_m * *before / (*before - *distance) - depth_m;
      if (!nearest || std::abs(crossing) < std::abs(*nearest)) nearest = crossing;
    }
    before = distance;
  }
  return nearest;
}

struct Bin {
  std::vector<double> errors_m;  // absolute
  double sum_m = 0.0;            // of the signed errors
  int rays = 0;
};
using Bins = std::array<Bin, kBins>;

void judge(const StaticMap& map, const Frame& frame, Bins& bins) {
  for (int y = kPixelStep / 2; y < frame.depth_m.height; y += kPixelStep)
    for (int x = kPixelStep / 2; x < frame.depth_m.width; x += kPixelStep) {
      const auto depth_m = static_cast<double>(frame.depth_m.at(x, y));
      if (!(depth_m > 0.05) || depth_m > 4.9) continue;
      Bin& bin = bins.at(static_cast<std::size_t>(depth_m / kBin_m));
      ++bin.rays;
      const Eigen::Vector3d ray = back_project(frame.depth_camera, x, y, 1.0F).cast<double>();
      const auto error_m = ray_error_m(map, *frame.T_world_camera, ray, depth_m);
      if (!error_m) continue;
      bin.errors_m.push_back(std::abs(*error_m));
      bin.sum_m += *error_m;
    }
}

/// A map merged from submaps of some frames.
class MergedMap {
 public:
  MergedMap(double resolution_m, const FusionConfig& config, int submap_frames)
      : merged{StaticMap(resolution_m, config), {}},
        submap_(resolution_m, config),
        submap_frames_(submap_frames) {}
  Fused merged;

  void fuse(const Frame& frame) {
    if (submap_frames_ == 0) return;
    if (fused_ == 0) T_world_submap_ = *frame.T_world_camera;
    (void)submap_.fuse(frame, T_world_submap_.inverse() * *frame.T_world_camera);
    if (++fused_ == submap_frames_) merge();
  }
  void merge() {
    if (fused_ == 0) return;
    const double start_ms = test::thread_ms();
    add_map(submap_, T_world_submap_, merged.map);
    merged.times.samples_ms.push_back(test::thread_ms() - start_ms);
    submap_ = StaticMap(merged.map.resolution_m(), merged.map.config());
    fused_ = 0;
  }

 private:
  StaticMap submap_;
  Eigen::Isometry3d T_world_submap_ = Eigen::Isometry3d::Identity();
  int submap_frames_, fused_ = 0;
};

nlohmann::json row_of(const WholeCell& cell, const Fused& fused, const Bins& bins) {
  nlohmann::json row = {{"source", cell.source},
                        {"resolution_m", cell.resolution_m},
                        {"max_cell_sigmas", fused.map.config().max_cell_sigmas},
                        {"fuse_median_ms", fused.times.percentile(0.5)},
                        {"fuse_p95_ms", fused.times.percentile(0.95)},
                        {"octree_mb", static_cast<double>(fused.map.counts().memory_bytes) / 1e6},
                        {"pool_mb", static_cast<double>(fused.map.memory_bytes()) / 1e6},
                        {"rays", nlohmann::json::array()}};
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const Bin& bin = bins[i];
    if (bin.rays < 100) continue;
    const auto found = static_cast<double>(bin.errors_m.size());
    row["rays"].push_back({{"from_m", static_cast<double>(i) * kBin_m},
                           {"rays", bin.rays},
                           {"error_median_m", test::quantile(bin.errors_m, 0.5)},
                           {"error_p90_m", test::quantile(bin.errors_m, 0.9)},
                           {"bias_m", bin.sum_m / std::max(found, 1.0)},
                           {"missed", 1.0 - found / bin.rays}});
  }
  return row;
}

}  // namespace

nlohmann::json whole_rows(const WholeCell& cell) {
  FusionConfig voxels, coarse;
  voxels.threads = coarse.threads = 1;
  voxels.max_cell_sigmas = 0.0F;
  coarse.max_cell_sigmas = static_cast<float>(cell.max_cell_sigmas);
  std::array<Fused, 2> maps{Fused{StaticMap(cell.resolution_m, voxels), {}},
                            Fused{StaticMap(cell.resolution_m, coarse), {}}};
  MergedMap submaps(cell.resolution_m, coarse, cell.submap_frames);
  for_frames(cell.source, [&](const Frame& frame, int number) {
    if (is_held_out(number)) return;
    for (Fused& fused : maps) {
      const double start_ms = test::thread_ms();
      (void)fused.map.fuse(frame, *frame.T_world_camera);
      fused.times.samples_ms.push_back(test::thread_ms() - start_ms);
    }
    submaps.fuse(frame);
  });
  submaps.merge();
  std::array<Bins, 3> bins;
  for_frames(cell.truth.empty() ? cell.source : cell.truth, [&](const Frame& frame, int number) {
    if (!is_held_out(number)) return;
    for (std::size_t i = 0; i < maps.size(); ++i) judge(maps[i].map, frame, bins[i]);
    if (cell.submap_frames > 0) judge(submaps.merged.map, frame, bins[2]);
  });
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < maps.size(); ++i) rows.push_back(row_of(cell, maps[i], bins[i]));
  if (cell.submap_frames > 0) {
    rows.push_back(row_of(cell, submaps.merged, bins[2]));
    rows.back()["submap_frames"] = cell.submap_frames;
  }
  return rows;
}

namespace {

// Runs a command of the program on the source and the map; returns its report.
nlohmann::json report_of(const std::string& command, const std::string& source,
                         const std::filesystem::path& folder, const std::string& options = {}) {
  const std::filesystem::path report = folder / (command + ".json");
  const std::string line = "'" ROOMRADAR_PROGRAM "' " + command + " '" + source + "' --map '" +
                           (folder / "map").string() + "' --report '" + report.string() + "' " + options +
                           " > /dev/null 2>&1";
  if (std::system(line.c_str()) != 0) throw Error(source + ": fails: " + line);
  return nlohmann::json::parse(std::ifstream(report));
}

// Returns the wall time, s, and the peak, MB, of a run from its start to the first composed picture.
nlohmann::json start_of_run(const std::string& source, const std::filesystem::path& folder) {
  const std::string pictures =
      "--frames 0:0 --pictures-stride 1 --pictures '" + (folder / "pictures").string() + "'";
  const auto start = std::chrono::steady_clock::now();
  const nlohmann::json told = report_of("run", source, folder, pictures);
  const std::chrono::duration<double> wall_s = std::chrono::steady_clock::now() - start;
  return {{"run_start_s", wall_s.count()}, {"run_start_peak_rss_mb", told["peak_rss_mb"]}};
}

}  // namespace

nlohmann::json scan_row(const std::string& source) {
  const TemporaryFolder folder;
  const std::filesystem::path map = folder.path() / "map";
  const nlohmann::json told = report_of("prescan", source, folder.path());
  double folder_bytes = 0.0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(map))
    if (entry.is_regular_file()) folder_bytes += static_cast<double>(entry.file_size());
  nlohmann::json row = {{"source", source},
                        {"frames", told["frames_read"]},
                        {"wall_s", told["wall_s"]},
                        {"ready_after_s", told["ready_after_s"]},
                        {"peak_rss_mb", told["peak_rss_mb"]},
                        {"folder_mb", folder_bytes / 1e6}};
  if (told.contains("ate_rmse_m")) row["ate_rmse_m"] = told["ate_rmse_m"];
  for (const char* stage : {"track", "optimise", "fuse", "ghosts", "surface", "coverage", "save"})
    if (told["stages"].contains(stage))
      row[std::string(stage) + "_median_ms"] = told["stages"][stage]["median_ms"];
  row.update(start_of_run(source, folder.path()));
  return row;
}

void print_whole(const nlohmann::json& rows) {
  for (const nlohmann::json& row : rows) {
    if (row.contains("submap_frames"))
      std::printf("merged from submaps of %d frames, time per submap:\n", row["submap_frames"].get<int>());
    std::printf("%s  max_cell_sigmas %.1f: fuse %.1f ms median, %.1f p95, octree %.1f MB, pools %.1f MB\n",
                row["source"].get<std::string>().c_str(), row["max_cell_sigmas"].get<double>(),
                row["fuse_median_ms"].get<double>(), row["fuse_p95_ms"].get<double>(),
                row["octree_mb"].get<double>(), row["pool_mb"].get<double>());
    for (const nlohmann::json& bin : row["rays"])
      std::printf("    %.1f m: %6d rays, error %6.2f mm median, %6.2f p90, bias %6.2f, missed %4.1f %%\n",
                  bin["from_m"].get<double>(), bin["rays"].get<int>(),
                  1e3 * bin["error_median_m"].get<double>(), 1e3 * bin["error_p90_m"].get<double>(),
                  1e3 * bin["bias_m"].get<double>(), 100.0 * bin["missed"].get<double>());
  }
}

}  // namespace roomradar::test
