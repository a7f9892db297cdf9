// map_bench.cpp: accuracy of a prescan's map, on simulated rooms whose surface is known exactly.
//
// usage: map_bench [--resolution M] [--json FILE] [poses SOURCE]...
//        map_bench [--resolution M] [--json FILE] [--sigmas S] [--truth SOURCE] [--submap-frames N]
//                  whole SOURCE
//        map_bench [--json FILE] scan SOURCE
//        poses: recorded (the true ones) or tracked; SOURCE: sim:ROOM?...
// Default: recorded and tracked on sim:table, 700 frames, once around the room and back.
//
//   distance   from points evenly distributed over the mesh to the room's surface
//   cover      fraction of the room's surface measured by at least 3 frames, within 5 m, that has mesh
//              within 2 cm
//   precision  fraction of the mesh within 2 cm of the surface; F-score: its harmonic mean with cover
//   gap        error of the last pose relative to the first
//
// `whole` runs the program's prescan of a recording, then fuses it with its own poses, with coarse cells and
// with voxels only, see map_bench_whole.hpp. `scan` runs the prescan, and one frame in its map.
//
// Settings are the defaults of PrescanConfig: changing them breaks the comparison with earlier results.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/cli/report.hpp"
#include "app/sim/scenarios/surface_score.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/prescan.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/map_bench_whole.hpp"

namespace roomradar {
namespace {

constexpr double kSpacing_m = 0.005;  // spacing of the points on the mesh

struct Cell {
  std::string poses;
  std::string source;
};

std::vector<Eigen::Vector3d> seen_surface(SimulatedSource& source) {
  SeenSurface seen;
  source.rewind();
  for (Frame frame; source.next(frame).status == ReadStatus::kFrame;) seen.add(frame, source.truth());
  return seen.points();
}

/// Returns the true camera poses at the frames of the trajectory's first and last pose.
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
  const SurfaceScore score =
      score_surface(scanned.map.mesh, T_room_map, source.room(), seen_surface(source), kSpacing_m);
  const double both = score.precision + score.cover;
  const std::map<std::string, StageSummary> stages = times.summaries();
  const MapCounts octree = scanned.map.octree.load().counts();
  nlohmann::json row = {
      {"source", cell.source},
      {"poses", cell.poses},
      {"resolution_m", resolution_m},
      {"frames", scanned.counts.frames_read},
      {"frames_fused", scanned.counts.frames_fused},
      {"error_median_m", score.error_median_m},
      {"error_p95_m", score.error_p95_m},
      {"cover", score.cover},
      {"precision", score.precision},
      {"f_score", both > 0 ? 2 * score.precision * score.cover / both : 0.0},
      {"end_gap_m", end_gap_m(scanned.map.trajectory, true_ends(scanned.map.trajectory, source))},
      {"triangles", scanned.map.mesh.triangles.size()},
      {"octree_bytes", octree.memory_bytes},
      {"peak_rss_mb", prescan_peak_mb},
      {"median_ms", stages.at("frame").median_ms},
      {"fuse_median_ms", stages.at("fuse").median_ms}};
  row["ate_rmse_m"] = nullptr;
  if (scanned.counts.trajectory_error) row["ate_rmse_m"] = scanned.counts.trajectory_error->rmse_m;
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
    roomradar::test::WholeCell whole;
    bool is_scan = false;
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      const std::string value = i + 1 < argc ? argv[++i] : "";
      if (word == "--resolution") {
        resolution_m = std::atof(value.c_str());
      } else if (word == "--json") {
        json = value;
      } else if (word == "--sigmas") {
        whole.max_cell_sigmas = std::atof(value.c_str());
      } else if (word == "--submap-frames") {
        whole.submap_frames = std::max(std::atoi(value.c_str()), 0);
      } else if (word == "--truth") {
        whole.truth = value;
      } else if ((word == "whole" || word == "scan") && !value.empty()) {
        whole.source = value;
        is_scan = word == "scan";
      } else if ((word == "recorded" || word == "tracked") && value.starts_with("sim:")) {
        cells.push_back({word, value});
      } else {
        std::fprintf(stderr,
                     "usage: map_bench [--resolution M] [--json FILE] [recorded|tracked sim:ROOM?...]...\n"
                     "       map_bench [--resolution M] [--json FILE] [--sigmas S] [--truth SOURCE] "
                     "[--submap-frames N] whole SOURCE\n"
                     "       map_bench [--json FILE] scan SOURCE\n");
        return 2;
      }
    }
    if (!whole.source.empty()) {
      whole.resolution_m = resolution_m;
      nlohmann::json rows = nlohmann::json::array();
      rows.push_back(roomradar::test::scan_row(whole.source));
      std::printf("%s\n", rows.back().dump().c_str());
      if (!is_scan) {
        const nlohmann::json cells_rows = roomradar::test::whole_rows(whole);
        roomradar::test::print_whole(cells_rows);
        rows.insert(rows.end(), cells_rows.begin(), cells_rows.end());
      }
      roomradar::test::write_rows(json, rows);
      return 0;
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
