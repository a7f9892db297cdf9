// building_bench.cpp: judges a building made from simulated recordings against their true poses.
//
//   roomradar simulate ...; roomradar building DIR --recordings LIST --report REPORT
//   building_bench DIR REPORT [--json FILE]
//
// The recordings' recorded poses must be the true ones, in one world.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "app/building/building_stages.hpp"
#include "mapping/building/building_info.hpp"
#include "mapping/building/submap_join.hpp"
#include "mapping/odometry/keyframe_graph.hpp"
#include "mapping/types/trajectory.hpp"
#include "tests/bench/bench_program.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// A submap with the true poses of its keyframes.
struct Truth {
  SubmapName name;
  Submap submap;
  std::vector<Eigen::Isometry3d> T_world_keyframe;
};

std::vector<Truth> truths_of(const BuildingInfo& info, const BuildingWork& work) {
  std::vector<Truth> truths;
  for (const BuildingRecording& recording : info.recordings)
    for (const SubmapName& name : submaps_of(work, recording.name)) {
      Truth truth{name, load_submap_poses(work.jobs() / name.folder()), {}};
      std::map<std::int64_t, Eigen::Isometry3d> T_of;
      for (const TimedPose& pose : truth.submap.recorded) T_of[pose.frame_index] = pose.T_world_camera;
      for (const MapKeyframe& keyframe : truth.submap.keyframes.keyframes)
        truth.T_world_keyframe.push_back(T_of.at(keyframe.frame_index));
      truths.push_back(std::move(truth));
    }
  return truths;
}

/// Number of b's keyframes with nearly the view of one of a's.
int same_views(const Truth& a, const Truth& b) {
  constexpr double kSameView = 0.5;  // of view_distance()
  return static_cast<int>(
      std::count_if(b.T_world_keyframe.begin(), b.T_world_keyframe.end(), [&](const auto& T_b) {
        return std::any_of(a.T_world_keyframe.begin(), a.T_world_keyframe.end(),
                           [&](const auto& T_a) { return view_distance(T_a.inverse() * T_b) < kSameView; });
      }));
}

struct Joins {
  int meeting = 0;  ///< pairs of recordings that truly share views
  int found = 0;    ///< of these, those with a right join that the building uses
  int wrong = 0;    ///< joins that the building uses, off by more than 0.3 m
  int refused_wrong = 0, refused_right = 0;
};

/// Error of a join's links: the median distance from the true relative pose, m.
double error_m(const SubmapJoin& join, const Truth& a, const Truth& b) {
  std::vector<double> errors;
  for (const KeyframeLink& link : join.links)
    errors.push_back(
        (link.T_a_b.inverse() * a.T_world_keyframe[link.a].inverse() * b.T_world_keyframe[link.b])
            .translation()
            .norm());
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  return errors[errors.size() / 2];
}

Joins judge_joins(const std::vector<Truth>& truths, const nlohmann::json& report, const BuildingWork& work) {
  constexpr double kWrong_m = 0.3;
  constexpr int kMeet = 5;  // views
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < truths.size(); ++i) index[truths[i].name.name()] = i;
  Joins joins;
  std::set<std::pair<std::size_t, std::size_t>> found;
  std::map<std::pair<std::string, std::string>, std::size_t> next;  // join of the pair
  for (const auto& row : report.at("joins")) {
    const auto pair = std::pair(row.at("a").get<std::string>(), row.at("b").get<std::string>());
    const std::size_t number = next[pair]++;
    if (!row.at("is_joined").get<bool>()) continue;
    const Truth &a = truths[index.at(pair.first)], &b = truths[index.at(pair.second)];
    const SubmapJoin join = load_joins(work.job(join_job(a.name, b.name)) / "joins.bin").at(number);
    const bool is_wrong = error_m(join, a, b) > kWrong_m, is_used = row.at("is_used").get<bool>();
    if (is_wrong) {
      ++(is_used ? joins.wrong : joins.refused_wrong);
      if (is_used)
        std::printf("wrong: %s %s, off %.2f m: %s\n", a.name.name().c_str(), b.name.name().c_str(),
                    error_m(join, a, b), describe(join).c_str());
    } else {
      joins.refused_right += is_used ? 0 : 1;
      if (is_used) found.insert(std::minmax(index.at(pair.first), index.at(pair.second)));
    }
  }
  for (std::size_t i = 0; i < truths.size(); ++i)
    for (std::size_t j = i + 1; j < truths.size(); ++j) {
      const int views = std::max(same_views(truths[i], truths[j]), same_views(truths[j], truths[i]));
      if (views < kMeet) continue;
      ++joins.meeting;
      if (found.contains({i, j}))
        ++joins.found;
      else
        std::printf("missed: %s %s, %d views\n", truths[i].name.name().c_str(), truths[j].name.name().c_str(),
                    views);
    }
  return joins;
}

struct Seams {
  std::size_t shared_vertices = 0;
  std::size_t edges = 0;  ///< between two shared vertices
  std::size_t open = 0;   ///< of these, those with one triangle only: cracks, and holes that touch a seam
  std::size_t triangles = 0;
};

Seams judge_seams(const BuildingInfo& info, const fs::path& folder) {
  using Point = std::array<double, 3>;
  std::map<Point, int> tiles_at;
  std::vector<Mesh> meshes;
  const auto point = [](const Mesh& mesh, std::uint32_t v) {
    const Eigen::Vector3d p = mesh.origin + mesh.vertices[v].cast<double>();
    return Point{p.x(), p.y(), p.z()};
  };
  Seams seams;
  for (const BuildingTile& tile : info.tiles) {
    meshes.push_back(read_tile_mesh(folder / tile.mesh.name));
    seams.triangles += meshes.back().triangles.size();
    for (std::uint32_t v = 0; v < meshes.back().vertices.size(); ++v) ++tiles_at[point(meshes.back(), v)];
  }
  std::map<std::pair<Point, Point>, int> edges;
  for (const Mesh& mesh : meshes)
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Point a = point(mesh, t[k]), b = point(mesh, t[(k + 1) % 3]);
        if (tiles_at[a] > 1 && tiles_at[b] > 1) ++edges[std::minmax(a, b)];
      }
  for (const auto& [at, count] : tiles_at) seams.shared_vertices += count > 1 ? 1 : 0;
  seams.edges = edges.size();
  for (const auto& [edge, count] : edges) seams.open += count == 1 ? 1 : 0;
  return seams;
}

}  // namespace

static int judge(const fs::path& folder, const fs::path& report_file, const std::string& json_file) {
  const BuildingInfo info = read_building(folder);
  BuildingWork work;
  work.folder = folder;
  std::ifstream in(report_file);
  const nlohmann::json report = nlohmann::json::parse(in);
  const std::vector<Truth> truths = truths_of(info, work);
  const Joins joins = judge_joins(truths, report, work);
  const Seams seams = judge_seams(info, folder);
  std::int64_t frames = 0, tracked = 0, placed = 0;
  for (const BuildingRecording& recording : info.recordings) {
    frames += recording.frames_read;
    tracked += recording.frames_tracked;
    placed += recording.frames_placed;
  }
  std::vector<double> ate_m;
  for (const Truth& truth : truths) {
    const TrajectoryError alone = absolute_trajectory_error(truth.submap.trajectory, truth.submap.recorded);
    ate_m.push_back(alone.rmse_m);
    std::printf("%s: %zu frames, alone RMSE %.1f mm, at most %.1f mm\n", truth.name.name().c_str(),
                truth.submap.trajectory.size(), 1e3 * alone.rmse_m, 1e3 * alone.max_m);
  }
  std::sort(ate_m.begin(), ate_m.end());
  std::printf(
      "%zu recordings in %zu parts; of %lld frames %lld tracked, %lld placed; parts alone: RMSE median %.1f "
      "mm, "
      "worst %.1f mm\n",
      info.recordings.size(), truths.size(), static_cast<long long>(frames), static_cast<long long>(tracked),
      static_cast<long long>(placed), 1e3 * ate_m[ate_m.size() / 2], 1e3 * ate_m.back());
  std::printf(
      "joins: %d pairs share views, %d of them joined; %d wrong joins used; refused: %d wrong, %d right\n",
      joins.meeting, joins.found, joins.wrong, joins.refused_wrong, joins.refused_right);
  std::printf("building: RMSE %.1f mm\n", 1e3 * report.value("ate_rmse_m", -1.0));
  std::printf("%zu tiles, %zu triangles; seams: %zu shared vertices, %zu edges, %zu of them open\n",
              info.tiles.size(), seams.triangles, seams.shared_vertices, seams.edges, seams.open);
  test::write_rows(json_file, nlohmann::json::array({{{"recordings", info.recordings.size()},
                                                      {"parts", truths.size()},
                                                      {"frames", frames},
                                                      {"frames_placed", placed},
                                                      {"meeting", joins.meeting},
                                                      {"found", joins.found},
                                                      {"wrong", joins.wrong},
                                                      {"ate_rmse_m", report.value("ate_rmse_m", -1.0)},
                                                      {"tiles", info.tiles.size()},
                                                      {"seam_edges", seams.edges},
                                                      {"seam_edges_open", seams.open}}}));
  return joins.wrong == 0 ? 0 : 1;
}

}  // namespace roomradar

int main(int argc, char** argv) {
  CLI::App app("building_bench: judges a building of simulated recordings by their true poses");
  std::string folder, report, json;
  app.add_option("DIR", folder, "the building")->required();
  app.add_option("REPORT", report, "report of `roomradar building`")->required();
  app.add_option("--json", json, "file to write (default: none)");
  CLI11_PARSE(app, argc, argv);
  return roomradar::test::run_or_say("building_bench",
                                     [&] { return roomradar::judge(folder, report, json); });
}
