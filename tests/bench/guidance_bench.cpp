// guidance_bench.cpp: new surface per second when a simulated scan follows the best next view.
//
// usage: guidance_bench [--scans N] [--rooms LIST] [--json FILE]
// Each simulated scan stops half way round the room. From there it goes on in two ways for the same time:
// along the old path, and to the best next view, three times, at the speeds that NextView assumes. New
// surface: points of the room's surface that a pixel of less than 4 m shows for the first time, in cells of 5
// cm.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <unordered_set>
#include <vector>

#include "app/scan/live/next_view.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/voxel_key.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/support/stored_view.hpp"

namespace roomradar {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kRate_hz = 5.0;
constexpr int kFrames = 100, kHalf = 50;

/// The surface seen so far, and the keyframes that showed it.
struct Seen {
  std::unordered_set<std::uint64_t> cells;
  std::vector<Keyframe> keyframes;

  double area_m2() const { return 0.05 * 0.05 * static_cast<double>(cells.size()); }
  void add(const Frame& frame, const SimTruth& truth, const Isometry3d& T_world_camera) {
    for (int y = 2; y < truth.depth_m.height; y += 4)
      for (int x = 2; x < truth.depth_m.width; x += 4) {
        const float depth_m = truth.depth_m.at(x, y);
        if (!(depth_m > 0.5F && depth_m < 4.0F)) continue;
        const Vector3d cell =
            (T_world_camera * back_project(frame.depth_camera, x, y, static_cast<double>(depth_m)) / 0.05)
                .array()
                .floor();
        cells.insert(voxel_key(cell.cast<int>().eval()));
      }
    keyframes.push_back({frame.index, T_world_camera, test::stored_view(frame), 0, 0.0});
  }
};

struct Outcome {
  double along_m2_s = 0.0, guided_m2_s = 0.0;
  int views = 0;
};

Isometry3d between(const Isometry3d& a, const Isometry3d& b, double share) {
  Isometry3d T = Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(a.linear()).slerp(share, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  T.translation() = a.translation() + share * (b.translation() - a.translation());
  return T;
}

Outcome scan(const std::string& room, int seed) {
  SimOptions options = parse_sim_spec("sim:" + room + "?seed=" + std::to_string(seed) + "&width=320");
  options.frames = kFrames;
  options.rate_hz = kRate_hz;
  SimulatedSource source(options);
  Seen seen;
  Frame frame;
  for (int i = 0; i < kHalf && source.next(frame).status == ReadStatus::kFrame; ++i)
    seen.add(frame, source.truth(), source.truth().T_world_camera);
  const double before_m2 = seen.area_m2();

  Outcome outcome;
  Seen guided = seen;
  Isometry3d camera = source.truth().T_world_camera;
  double passed_s = 0.0;
  for (; outcome.views < 3; ++outcome.views) {
    const std::optional<NextView> next =
        best_next_view(explored_around(camera.translation(), guided.keyframes), camera, Vector3d::UnitZ());
    if (!next) break;
    const int frames = std::max(1, static_cast<int>(std::ceil(next->takes_s * kRate_hz)));
    for (int i = 1; i <= frames; ++i) {
      const Isometry3d at = between(camera, next->T_world_camera, static_cast<double>(i) / frames);
      source.look(kHalf, at, frame);
      guided.add(frame, source.truth(), at);
    }
    passed_s += frames / kRate_hz;
    camera = next->T_world_camera;
  }
  if (outcome.views == 0) return outcome;
  outcome.guided_m2_s = (guided.area_m2() - before_m2) / passed_s;

  // Along the old path for as long.
  const int along = std::min(kFrames - kHalf, static_cast<int>(std::lround(passed_s * kRate_hz)));
  static_cast<void>(source.seek(kHalf));
  for (int i = 0; i < along && source.next(frame).status == ReadStatus::kFrame; ++i)
    seen.add(frame, source.truth(), source.truth().T_world_camera);
  outcome.along_m2_s = (seen.area_m2() - before_m2) / (along / kRate_hz);
  return outcome;
}

int bench(int argc, char** argv) {
  int scans = 5;
  std::string rooms = "table,shelf,random,board", json;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--scans")
      scans = std::atoi(argv[i + 1]);
    else if (name == "--rooms")
      rooms = argv[i + 1];
    else if (name == "--json")
      json = argv[i + 1];
    else
      throw Error("usage: guidance_bench [--scans N] [--rooms LIST] [--json FILE]");
  }
  std::vector<double> ratios;
  double along = 0.0, guided = 0.0;
  std::istringstream list(rooms);
  for (std::string room; std::getline(list, room, ',');)
    for (int seed = 1; seed <= scans; ++seed) {
      const Outcome outcome = scan(room, seed);
      const double ratio = outcome.guided_m2_s / std::max(outcome.along_m2_s, 1e-3);
      ratios.push_back(ratio);
      along += outcome.along_m2_s;
      guided += outcome.guided_m2_s;
      std::printf("%-8s seed %2d: %.3f m2/s along the path, %.3f guided by %d views: %.2f times\n",
                  room.c_str(), seed, outcome.along_m2_s, outcome.guided_m2_s, outcome.views, ratio);
      std::fflush(stdout);
    }
  std::sort(ratios.begin(), ratios.end());
  const double median = ratios[ratios.size() / 2];
  const auto twice = std::count_if(ratios.begin(), ratios.end(), [](double r) { return r >= 2.0; });
  std::printf("all %zu: median %.2f times, at least twice in %td, sums %.2f times\n", ratios.size(), median,
              twice, guided / along);
  test::write_rows(json, nlohmann::json{{"scans", ratios.size()},
                                        {"median_ratio", median},
                                        {"twice", twice},
                                        {"ratio_of_sums", guided / along}});
  return 0;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("guidance_bench", [&] { return roomradar::bench(argc, argv); });
}
