// slide_bench.cpp: bodies without friction that slide over the floor of saved maps: what they keep of their
// speed, and how far they are lifted.
//
// usage: slide_bench [--lanes N] [--length M] [--step M] [--friction F] [--rolling R] [--roll 0|1] [--reach
// M]
//                    [--shapes A,B,...] [--seed N] [--trace SHAPE,LANE] [--json FILE] MAP...
//        MAP: a saved map, in which unknown space is solid, as in a run
//
// Each body starts at 1.5 m/s along N (40) lanes of M (2) metres over level floor without obstacles, in
// random directions. Restitution is 0. With --roll 1, it starts with the spin of a rolling ball.
//   end    speed after the lane, m/s: least, median, greatest; 0 if the body does not reach the end in 4 s
//   lift   greatest height of the centre of mass above that of the body at rest at the start, mm
//   high   the same above the floor's plane, which is fitted to the lane, relative to the start
//   floor  the greatest height of the floor's points within 3 cm of the lane's line, over the highest within
//          3 cm of its start: a body cannot stay lower than that without entering the floor
//   aside  greatest distance from the lane's line, mm
//
// Lanes, shapes and seeds are fixed: changing them breaks the comparison with earlier results.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <list>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

#include "bench_program.hpp"
#include "bench_times.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "physics_bench_scenes.hpp"

namespace roomradar::bench {
namespace {

using Vec3 = Eigen::Vector3d;
constexpr double kFrame_s = 1.0 / 30.0, kSpeed_mps = 1.5;

struct Options {
  int lanes = 40;
  double length_m = 2.0, step_m = 0.008, reach_m = PhysicsConfig().patch_reach_m, friction = 0.0,
         rolling = 0.0;
  bool rolls = false;
  std::string shapes, json, trace;
  unsigned seed = 1;
  std::vector<std::string> maps;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (!name.starts_with("--")) {
      options.maps.push_back(name);
      continue;
    }
    if (++i == argc) throw Error(name + ": has no value");
    const std::string value = argv[i];
    if (name == "--lanes")
      options.lanes = std::clamp(std::atoi(value.c_str()), 1, 10'000);
    else if (name == "--length")
      options.length_m = std::clamp(std::atof(value.c_str()), 0.1, 20.0);
    else if (name == "--step")
      options.step_m = std::atof(value.c_str());
    else if (name == "--reach")
      options.reach_m = std::atof(value.c_str());
    else if (name == "--friction")
      options.friction = std::atof(value.c_str());
    else if (name == "--rolling")
      options.rolling = std::atof(value.c_str());
    else if (name == "--roll")
      options.rolls = value == "1";
    else if (name == "--shapes")
      options.shapes = "," + value + ",";
    else if (name == "--seed")
      options.seed = static_cast<unsigned>(std::atoi(value.c_str()));
    else if (name == "--trace")
      options.trace = value;
    else if (name == "--json")
      options.json = value;
    else
      throw Error(name + ": not known; see the first lines of slide_bench.cpp");
  }
  if (options.maps.empty()) throw Error("needs the folder of a saved map");
  return options;
}

/// A closed prism about the z axis.
Mesh prism_mesh(int sides, double radius_m, double height_m) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(sides);
  for (const double side : {-0.5, 0.5})
    for (int i = 0; i < sides; ++i) {
      const double a = 2.0 * std::numbers::pi * i / sides;
      mesh.vertices.push_back(
          Vec3(radius_m * std::cos(a), radius_m * std::sin(a), side * height_m).cast<float>());
    }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({i, next, n + next});
    mesh.triangles.push_back({i, n + next, n + i});
    if (i == 0 || i + 1 == n) continue;
    mesh.triangles.push_back({0, i + 1, i});
    mesh.triangles.push_back({n, n + i, n + i + 1});
  }
  return mesh;
}

/// A needle lies on its side.
Mesh lying(Mesh mesh) {
  for (Eigen::Vector3f& v : mesh.vertices) v = {v.z(), v.y(), -v.x()};
  return mesh;
}

struct Lane {
  Vec3 start, direction;
  double floor_m = 0.0;                                  ///< how far the floor itself rises over its start
  Vec3 normal = Vec3::UnitZ(), on_plane = Vec3::Zero();  ///< plane fitted to the floor along the lane
};

/// The floor of a map in cells of 5 cm.
class Floor {
 public:
  explicit Floor(const Mesh& room) {
    for (const Triangle& triangle : room.triangles) {
      const auto corner = [&](std::size_t k) -> Vec3 {
        return room.origin + room.vertices[triangle[k]].cast<double>();
      };
      const Vec3 a = corner(0), b = corner(1) - a, c = corner(2) - a;
      const int steps =
          1 + static_cast<int>(std::max({b.norm(), c.norm(), (b - c).norm()}) / (0.4 * kCell_m));
      for (int i = 0; i <= steps; ++i)
        for (int k = 0; i + k <= steps; ++k) add(a + (i * b + k * c) / steps);
    }
  }

  /// Returns random lanes over level cells with nothing in the way, and no step such as a carpet's border.
  [[nodiscard]] std::vector<Lane> lanes(int count, double length_m, double step_m, unsigned seed) const {
    std::vector<const Vec3*> starts;
    for (const auto& [key, cell] : cells_)
      if (!cell.is_blocked && !cell.level.empty()) starts.push_back(&cell.level.front());
    if (starts.empty()) throw Error("the map has no level floor at z = 0");
    std::mt19937 random(seed);
    std::vector<Lane> lanes;
    for (int attempt = 0; attempt < 2'000'000 && static_cast<int>(lanes.size()) < count; ++attempt) {
      Lane lane;
      lane.start = *starts[random() % starts.size()];
      // Every fourth lane runs along the lattice of cells or its diagonals.
      const auto drawn = static_cast<int>(random() % 3600);
      const double angle =
          lanes.size() % 4 == 3 ? drawn % 8 * std::numbers::pi / 4.0 : drawn * std::numbers::pi / 1800.0;
      lane.direction = {std::cos(angle), std::sin(angle), 0.0};
      if (!is_free(lane, length_m)) continue;
      lane = fitted(lane, length_m);
      if (is_even(lane, length_m, step_m)) lanes.push_back(lane);
    }
    if (static_cast<int>(lanes.size()) < count) throw Error("the floor has no room for such lanes");
    return lanes;
  }

 private:
  static constexpr double kCell_m = 0.05, kLevel_m = 0.025, kHigh_m = 0.3, kHalfWidth_m = 0.15;
  struct Cell {
    std::vector<Vec3> level;
    bool is_blocked = false;
  };
  using Key = std::pair<int, int>;
  std::map<Key, Cell> cells_;

  void add(const Vec3& p) {
    if (std::abs(p.z()) < kLevel_m)
      cells_[key(p)].level.push_back(p);
    else if (p.z() > 0.0 && p.z() < kHigh_m)
      cells_[key(p)].is_blocked = true;
  }
  static Key key(const Vec3& p) {
    return {static_cast<int>(std::floor(p.x() / kCell_m)), static_cast<int>(std::floor(p.y() / kCell_m))};
  }
  template <typename Visit>
  bool all_cells(const Lane& lane, double length_m, const Visit& visit) const {
    const Vec3 aside = Vec3::UnitZ().cross(lane.direction);
    for (double along = -kHalfWidth_m; along < length_m + kHalfWidth_m; along += 0.5 * kCell_m)
      for (double across = -kHalfWidth_m; across < kHalfWidth_m; across += 0.5 * kCell_m) {
        const auto cell = cells_.find(key(lane.start + along * lane.direction + across * aside));
        if (cell == cells_.end() || !visit(cell->second)) return false;
      }
    return true;
  }
  [[nodiscard]] bool is_free(const Lane& lane, double length_m) const {
    return all_cells(lane, length_m,
                     [](const Cell& cell) { return !cell.is_blocked && !cell.level.empty(); });
  }
  [[nodiscard]] bool is_even(const Lane& lane, double length_m, double step_m) const {
    return all_cells(lane, length_m, [&](const Cell& cell) {
      return std::all_of(cell.level.begin(), cell.level.end(), [&](const Vec3& p) {
        return std::abs(lane.normal.dot(p - lane.on_plane)) < 0.5 * step_m;
      });
    });
  }
  [[nodiscard]] Lane fitted(Lane lane, double length_m) const {
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    Vec3 sums = Vec3::Zero();
    (void)all_cells(lane, length_m, [&](const Cell& cell) {
      for (const Vec3& p : cell.level) {
        const Vec3 row(p.x() - lane.start.x(), p.y() - lane.start.y(), 1.0);
        moments += row * row.transpose();
        sums += p.z() * row;
      }
      return true;
    });
    const Vec3 plane = moments.ldlt().solve(sums), aside = Vec3::UnitZ().cross(lane.direction);
    constexpr double kNear_m = 0.03;
    double start_m = -1.0, most_m = -1.0;
    (void)all_cells(lane, length_m, [&](const Cell& cell) {
      for (const Vec3& p : cell.level) {
        const Vec3 way = p - lane.start;
        if (std::abs(aside.dot(way)) > kNear_m) continue;
        const double along = lane.direction.dot(way);
        if (std::abs(along) < kNear_m) start_m = std::max(start_m, p.z());
        if (along > -kNear_m && along < length_m) most_m = std::max(most_m, p.z());
      }
      return true;
    });
    lane.floor_m = most_m - start_m;
    lane.normal = Vec3(-plane.x(), -plane.y(), 1.0).normalized();
    lane.on_plane = {lane.start.x(), lane.start.y(), plane.z()};
    return lane;
  }
};

struct Slide {
  double end_mps = 0.0, lift_m = -1.0, high_m = -1.0, aside_m = 0.0;
};

/// Rests the body on the lane's start, then slides it to the lane's end.
Slide slide(const Thing& thing, const Lane& lane, const Options& options, bool traces, World& world,
            test::Times& times) {
  PhysicsConfig config;
  config.friction = options.friction;
  config.rolling = options.rolling;
  config.patch_reach_m = options.reach_m;
  Body body;
  body.mass = thing.mass;
  double low_m = 0.0;
  for (const Eigen::Vector3f& v : thing.mesh.vertices) low_m = std::min(low_m, double{v.z()});
  body.T_world_object.rotate(
      Eigen::AngleAxisd(std::atan2(lane.direction.y(), lane.direction.x()), Vec3::UnitZ()));
  body.T_world_object.pretranslate(lane.start + Vec3(0, 0, 0.015 - low_m));
  PhysicsConfig sticky = config;  // so that it stays at the start
  sticky.friction = 1.0;
  sticky.rolling = 0.5;
  for (int frame = 0; frame < 30 && !body.asleep; ++frame) (void)world.step(body, thing, kFrame_s, sticky);
  body.asleep = false;
  const Vec3 start = centre_world(body);
  body.velocity_world_mps = kSpeed_mps * lane.direction;
  body.angular_velocity_world_rad_s.setZero();
  if (options.rolls)
    body.angular_velocity_world_rad_s = kSpeed_mps / -low_m * Vec3::UnitZ().cross(lane.direction);
  Slide result;
  for (int frame = 0; frame < 120; ++frame) {
    const double before_ms = test::thread_ms();
    (void)world.step(body, thing, kFrame_s, config);
    times.samples_ms.push_back(test::thread_ms() - before_ms);
    const Vec3 way = centre_world(body) - start;
    result.lift_m = std::max(result.lift_m, way.z());
    result.high_m = std::max(result.high_m, way.dot(lane.normal));
    result.aside_m = std::max(result.aside_m, std::abs(Vec3::UnitZ().cross(lane.direction).dot(way)));
    if (traces)
      std::printf("  %3d  along %.3f aside %.4f up %6.2f mm  v %7.4f %7.4f %7.4f  spin %6.2f\n", frame,
                  way.dot(lane.direction), Vec3::UnitZ().cross(lane.direction).dot(way), 1e3 * way.z(),
                  body.velocity_world_mps.dot(lane.direction),
                  body.velocity_world_mps.dot(Vec3::UnitZ().cross(lane.direction)),
                  body.velocity_world_mps.z(), body.angular_velocity_world_rad_s.norm());
    if (way.dot(lane.direction) < options.length_m) continue;
    result.end_mps = body.velocity_world_mps.norm();
    break;
  }
  return result;
}

std::list<Thing> things_of(const Options& options) {
  std::list<Thing> things;
  const auto add = [&](const char* name, Mesh mesh) {
    if (options.shapes.empty() || options.shapes.find("," + std::string(name) + ",") != std::string::npos)
      things.emplace_back(name, std::move(mesh));
  };
  add("ball", ball_mesh(0.05, 14));
  add("puck", prism_mesh(32, 0.06, 0.03));
  add("cube", box_mesh({0.1, 0.1, 0.1}));
  add("marble", ball_mesh(0.01, 4));
  add("card", prism_mesh(4, 0.06, 0.0008));
  add("needle", lying(prism_mesh(6, 0.0015, 0.2)));
  return things;
}

int run(int argc, char** argv) {
  const Options options = parse(argc, argv);
  nlohmann::json rows = nlohmann::json::array();
  std::printf("%s\n%d lanes of %.1f m, friction %.2f\n%-24s %-7s %26s %17s %17s %17s %8s %9s %8s\n",
              test::processor().c_str(), options.lanes, options.length_m, options.friction, "map", "shape",
              "end m/s least median most", "lift mm median most", "high mm median most",
              "floor mm median most", "aside mm", "ms median", "p95");
  for (const std::string& folder : options.maps) {
    const SavedMap map = load_map(folder);
    const std::vector<Lane> lanes =
        Floor(map.mesh).lanes(options.lanes, options.length_m, options.step_m, options.seed);
    World world;
    world.add(map.mesh);
    world.add(
        (map.unknown.load() ? *map.unknown.load() : unknown_surface(map.octree.load(), map.mesh)).mesh_world,
        SurfaceKind::kUnknownFrontier);
    const std::string name = folder.substr(folder.find_last_of('/') + 1);
    for (const Thing& thing : things_of(options)) {
      test::Times times;
      std::vector<double> end, lift, high, floor, aside;
      for (std::size_t i = 0; i < lanes.size(); ++i) {
        const bool traces = options.trace == thing.name + "," + std::to_string(i);
        const Slide result = slide(thing, lanes[i], options, traces, world, times);
        end.push_back(result.end_mps);
        lift.push_back(1e3 * result.lift_m);
        high.push_back(1e3 * result.high_m);
        floor.push_back(1e3 * lanes[i].floor_m);
        aside.push_back(1e3 * result.aside_m);
        if (!options.trace.empty())
          std::printf(
              "  %s %zu from %.3f %.3f %.3f along %.3f %.3f: %.3f m/s, lift %.2f, high %.2f, aside %.2f mm\n",
              thing.name.c_str(), i, lanes[i].start.x(), lanes[i].start.y(), lanes[i].start.z(),
              lanes[i].direction.x(), lanes[i].direction.y(), result.end_mps, lift.back(), high.back(),
              aside.back());
      }
      for (auto* values : {&end, &lift, &high, &floor, &aside}) std::sort(values->begin(), values->end());
      const std::size_t middle = end.size() / 2;
      std::printf("%-24s %-7s %10.3f %7.3f %7.3f %9.2f %7.2f %9.2f %7.2f %9.2f %7.2f %8.1f %9.3f %8.3f\n",
                  name.c_str(), thing.name.c_str(), end.front(), end[middle], end.back(), lift[middle],
                  lift.back(), high[middle], high.back(), floor[middle], floor.back(), aside.back(),
                  times.percentile(0.5), times.percentile(0.95));
      std::fflush(stdout);
      rows.push_back({{"map", name},
                      {"shape", thing.name},
                      {"friction", options.friction},
                      {"end_least_mps", end.front()},
                      {"end_median_mps", end[middle]},
                      {"end_most_mps", end.back()},
                      {"lift_median_mm", lift[middle]},
                      {"lift_most_mm", lift.back()},
                      {"high_most_mm", high.back()},
                      {"floor_most_mm", floor.back()},
                      {"aside_most_mm", aside.back()},
                      {"median_ms", times.percentile(0.5)},
                      {"p95_ms", times.percentile(0.95)}});
    }
  }
  test::write_rows(options.json, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar::bench

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("slide_bench", [&] { return roomradar::bench::run(argc, argv); });
}
