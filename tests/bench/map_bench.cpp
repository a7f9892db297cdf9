// map_bench.cpp: how true a prescan's map is, on simulated rooms whose surface is known exactly.
//
// usage: map_bench [--resolution M] [--json FILE] [poses SOURCE]...
//        poses: recorded (the true ones) or tracked; SOURCE: sim:ROOM?...
// Without cells: recorded and tracked on sim:table, 700 frames, once round the room and back.
//
// distance   of points spread evenly over the mesh to the room's surface
// cover      part of the room's surface that at least 3 frames measured, within 5 m, that has mesh within 2
// cm precision  part of the mesh within 2 cm of the surface; F-score: its harmonic mean with cover gap error
// of the last pose relative to the first Settings are the defaults of PrescanConfig; changing them breaks
// comparison with old numbers.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_map>
#include <vector>

#include "app/report.hpp"
#include "app/sim/room.hpp"
#include "app/sim/simulated_source.hpp"
#include "mapping/prescan.hpp"
#include "mapping/types/cell_code.hpp"
#include "tests/bench/bench_program.hpp"

namespace roomradar {
namespace {

constexpr double kCovered_m = 0.02;
constexpr double kSpacing_m = 0.005;  // of the points spread over the mesh
constexpr float kFarthest_m = 5.0F;   // FusionConfig::max_range_m
constexpr int kStride_px = 4;
constexpr int kFramesSeen = 3;

struct Cell {
  std::string poses;
  std::string source;
};

Eigen::Vector3i cell_of(const Eigen::Vector3d& p) { return (p / kCovered_m).array().floor().cast<int>(); }

/// Points of the true surface, one a 2 cm cell, that enough frames measured. Room frame.
std::vector<Eigen::Vector3d> seen_surface(SimulatedSource& source) {
  struct Seen {
    Eigen::Vector3d point;
    std::int64_t last_frame = -1;
    int frames = 0;
  };
  std::unordered_map<std::uint64_t, Seen> cells;
  source.rewind();
  Frame frame;
  while (source.next(frame).status == ReadStatus::kFrame) {
    const SimTruth& truth = source.truth();
    for (int y = 0; y < frame.depth_m.height; y += kStride_px) {
      for (int x = 0; x < frame.depth_m.width; x += kStride_px) {
        const float measured = frame.depth_m.at(x, y);
        const double z = truth.depth_m.at(x, y);
        if (!(measured > 0.0F && measured <= kFarthest_m && z > 0.0) || truth.moved.at(x, y) != 0) continue;
        const Intrinsics& camera = frame.depth_camera;
        const Eigen::Vector3d p_camera((x - camera.cx_px) / camera.fx_px * z,
                                       (y - camera.cy_px) / camera.fy_px * z, z);
        const Eigen::Vector3d p_room = truth.T_world_camera * p_camera;
        Seen& seen = cells.try_emplace(cell_code(cell_of(p_room)), Seen{p_room}).first->second;
        if (seen.last_frame == frame.index) continue;
        seen.last_frame = frame.index;
        ++seen.frames;
      }
    }
  }
  std::vector<Eigen::Vector3d> points;
  for (const auto& [key, seen] : cells) {
    if (seen.frames >= kFramesSeen) points.push_back(seen.point);
  }
  return points;
}

/// Points on a lattice of each triangle, no more than kSpacing_m apart, each with the area it stands for.
struct SurfacePoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> areas_m2;
};

SurfacePoints spread_points(const Mesh& mesh, const Eigen::Isometry3d& T_room_map) {
  SurfacePoints spread;
  for (const Triangle& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
      return T_room_map * (mesh.origin + mesh.vertices[triangle[i]].cast<double>());
    };
    const Eigen::Vector3d a = corner(0), ab = corner(1) - a, ac = corner(2) - a;
    const double longest_m = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int parts = std::max(1, static_cast<int>(std::ceil(longest_m / kSpacing_m)));
    const double area_m2 = 0.5 * ab.cross(ac).norm();
    const double step = 1.0 / parts;
    const auto add = [&](double u, double v) {
      spread.points.push_back(a + u * ab + v * ac);
      spread.areas_m2.push_back(area_m2 / (parts * parts));
    };
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; i + j < parts; ++j) {
        add((i + 1.0 / 3.0) * step, (j + 1.0 / 3.0) * step);
        if (i + j + 1 < parts) add((i + 2.0 / 3.0) * step, (j + 2.0 / 3.0) * step);
      }
    }
  }
  return spread;
}

/// The size that `part` of the total weight lies under.
double weighted_quantile(std::vector<std::pair<double, double>> size_and_weight, double part) {
  std::sort(size_and_weight.begin(), size_and_weight.end());
  double total = 0.0;
  for (const auto& [size, weight] : size_and_weight) total += weight;
  double sum = 0.0;
  for (const auto& [size, weight] : size_and_weight) {
    sum += weight;
    if (sum >= part * total) return size;
  }
  return 0.0;
}

/// Part of `points` that have one of `spread` within kCovered_m.
double covered_part(const std::vector<Eigen::Vector3d>& points, const SurfacePoints& spread) {
  std::unordered_multimap<std::uint64_t, std::size_t> near;
  for (std::size_t i = 0; i < spread.points.size(); ++i)
    near.emplace(cell_code(cell_of(spread.points[i])), i);
  std::size_t covered = 0;
  for (const Eigen::Vector3d& point : points) {
    bool found = false;
    for (int n = 0; n < kCellsRound && !found; ++n) {
      const auto [begin, end] = near.equal_range(cell_code(cell_of(point) + cell_round(n)));
      found = std::any_of(begin, end, [&](const auto& entry) {
        return (spread.points[entry.second] - point).squaredNorm() <= kCovered_m * kCovered_m;
      });
    }
    covered += found ? 1 : 0;
  }
  return points.empty() ? 0.0 : static_cast<double>(covered) / static_cast<double>(points.size());
}

/// Where the camera truly was in the frames of the trajectory's first and last pose.
std::vector<TimedPose> true_ends(const std::vector<TimedPose>& trajectory, SimulatedSource& source) {
  if (trajectory.empty()) return {};
  std::vector<TimedPose> ends{trajectory.front(), trajectory.back()};
  Frame frame;
  for (TimedPose& end : ends) {
    source.seek(end.frame_index);
    (void)source.next(frame);
    end.T_world_camera = source.truth().T_world_camera;
  }
  return ends;
}

nlohmann::json judge(const Cell& cell, double resolution_m) {
  SimulatedSource source(parse_sim_spec(cell.source));
  PrescanConfig config;
  config.resolution_m = resolution_m;
  config.poses = cell.poses == "recorded" ? PoseOrigin::kRecorded : PoseOrigin::kTracked;
  StageTimes times;
  const PrescanResult scanned = prescan(source, config, times);
  const double prescan_peak_mb = peak_rss_mb();

  const Eigen::Isometry3d T_room_map = scanned.map.info.T_world_recorded.inverse();
  const SurfacePoints spread = spread_points(scanned.map.mesh, T_room_map);
  std::vector<std::pair<double, double>> distances;
  double area_m2 = 0.0, precise_m2 = 0.0;
  for (std::size_t i = 0; i < spread.points.size(); ++i) {
    const double distance_m = std::abs(signed_distance_m(source.room(), spread.points[i]));
    distances.emplace_back(distance_m, spread.areas_m2[i]);
    area_m2 += spread.areas_m2[i];
    if (distance_m <= kCovered_m) precise_m2 += spread.areas_m2[i];
  }
  const double precision = area_m2 > 0.0 ? precise_m2 / area_m2 : 0.0;
  const double cover = covered_part(seen_surface(source), spread);
  const std::map<std::string, StageSummary> stages = times.summaries();
  const MapCounts octree = scanned.map.octree.counts();
  nlohmann::json row = {
      {"source", cell.source},
      {"poses", cell.poses},
      {"resolution_m", resolution_m},
      {"frames", scanned.counts.frames_read},
      {"frames_fused", scanned.counts.frames_fused},
      {"error_median_m", weighted_quantile(distances, 0.5)},
      {"error_p95_m", weighted_quantile(distances, 0.95)},
      {"cover", cover},
      {"precision", precision},
      {"f_score", precision + cover > 0 ? 2 * precision * cover / (precision + cover) : 0.0},
      {"end_gap_m", end_gap_m(scanned.map.trajectory, true_ends(scanned.map.trajectory, source))},
      {"triangles", scanned.map.mesh.triangles.size()},
      {"octree_bytes", octree.memory_bytes},
      {"peak_rss_mb", prescan_peak_mb},
      {"median_ms", stages.at("frame").median_ms},
      {"fuse_median_ms", stages.at("fuse").median_ms}};
  row["ate_rmse_m"] = nullptr;
  if (scanned.counts.against_recorded) row["ate_rmse_m"] = scanned.counts.against_recorded->rmse_m;
  return row;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  using roomradar::Cell;
  return roomradar::test::run_or_say("map_bench", [&] {
    double resolution_m = 0.01;
    std::string json;
    std::vector<Cell> cells;
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      const std::string value = i + 1 < argc ? argv[++i] : "";
      if (word == "--resolution") {
        resolution_m = std::atof(value.c_str());
      } else if (word == "--json") {
        json = value;
      } else if ((word == "recorded" || word == "tracked") && value.starts_with("sim:")) {
        cells.push_back({word, value});
      } else {
        std::fprintf(stderr,
                     "usage: map_bench [--resolution M] [--json FILE] [recorded|tracked sim:ROOM?...]...\n");
        return 2;
      }
    }
    if (cells.empty()) cells = {{"recorded", "sim:table?frames=700"}, {"tracked", "sim:table?frames=700"}};
    nlohmann::json rows = nlohmann::json::array();
    for (const Cell& cell : cells) {
      rows.push_back(roomradar::judge(cell, resolution_m));
      std::printf("%s\n", rows.back().dump().c_str());
      std::fflush(stdout);
    }
    roomradar::test::write_rows(json, rows);
    return 0;
  });
}
