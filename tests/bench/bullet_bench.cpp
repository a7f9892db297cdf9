// bullet_bench.cpp: heaps and throws, simulated by the project and by Bullet in the same run.
//
// usage: bullet_bench [--map FOLDER --at X,Y,Z] [--objects N] [--throws N] [--only heap|throws]
//                     [--engines ours|all] [--seed N] [--json FILE]
//        FOLDER: a saved map, in which unknown space is solid, as in a run. Objects are dropped from 0.9 m
//        above the point, which must be known space. Without it: the simulated table room.
//
//   heap    N (50) boxes, balls and teapots of 5 to 15 cm, one every second frame or once its place is free,
//           300 frames
//     entered bodies whose place became free
//     asleep  bodies at rest at the end
//     crossed bodies whose surface another one's or the room's crosses at the end, and the greatest depth
//     gone    bodies that have fallen through everything
//   throws  N (600) cubes, plates, needles and balls, each alone in a simulated room, at up to 10 m/s, 4 s
//     outside bodies that have left the room
//
// Scenes and seeds are fixed: changing them breaks the comparison with earlier results.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <list>
#include <nlohmann/json.hpp>
#include <random>
#include <span>
#include <string>

#include "app/objects/teapot.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "bench_program.hpp"
#include "bullet_bench_scenes.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"

namespace roomradar::bench {
namespace {

using Vec3 = Eigen::Vector3d;

struct Options {
  std::string map, only, engines = "all", json;
  Vec3 at_world = Vec3::Zero();
  int objects = 50, throws = 600;
  unsigned seed = 5;  ///< of the heap
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    if (i + 1 == argc) throw Error(name + ": has no value");
    if (name == "--map") {
      options.map = argv[i + 1];
    } else if (name == "--at") {
      if (std::sscanf(argv[i + 1], "%lf,%lf,%lf", &options.at_world[0], &options.at_world[1],
                      &options.at_world[2]) != 3)
        throw Error("--at " + std::string(argv[i + 1]) + ": needs three numbers X,Y,Z (m)");
    } else if (name == "--objects") {
      options.objects = std::clamp(std::atoi(argv[i + 1]), 1, 1000);
    } else if (name == "--throws") {
      options.throws = std::clamp(std::atoi(argv[i + 1]), 1, 1'000'000);
    } else if (name == "--only") {
      options.only = argv[i + 1];
    } else if (name == "--engines") {
      options.engines = argv[i + 1];
      if (options.engines != "ours" && options.engines != "all")
        throw Error("--engines " + options.engines + ": must be ours or all");
    } else if (name == "--seed") {
      options.seed = static_cast<unsigned>(std::clamp(std::atoi(argv[i + 1]), 0, 1'000'000));
    } else if (name == "--json") {
      options.json = argv[i + 1];
    } else {
      throw Error(name +
                  ": not known; there are --map, --at, --objects, --throws, --only, --engines, --seed and "
                  "--json");
    }
  }
  return options;
}

/// A way to simulate a scene.
struct Engine {
  const char* name;
  Simulated (*simulate)(const Surroundings&, const std::vector<Entry>&, int);
};
const std::array<Engine, 3> kEngines = {{
    {"roomradar", &simulate},
    {"Bullet",
     [](const Surroundings& surroundings, const std::vector<Entry>& entries, int frames) {
       return simulate_with_bullet(surroundings, entries, frames, BulletMotion::kDiscrete);
     }},
    {"Bullet, CCD",
     [](const Surroundings& surroundings, const std::vector<Entry>& entries, int frames) {
       return simulate_with_bullet(surroundings, entries, frames, BulletMotion::kContinuous);
     }},
}};

/// Returns the engines to run: ours is the first.
std::span<const Engine> engines_of(const Options& options) {
  return std::span(kEngines).first(options.engines == "ours" ? 1 : kEngines.size());
}

/// Returns how deep a tree overlaps a scene: the least over the directions of the axes; 0 if none crosses it.
double overlap_m(const TreeInstance& object, std::span<const SceneTree> scene, CyberRadar& radar) {
  std::vector<ClosestPoint> unused;
  if (near_features(object, {scene, {}}, 1e-6, 0, {}, unused) == 0) return 0.0;
  double least_m = 1.0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Contact contact = radar.query({object, side * Vec3::Unit(axis), 0.01}, {scene, {}});
      if (contact.status == ContactStatus::kOverlap) least_m = std::min(least_m, -contact.contact_distance_m);
    }
  return least_m;
}

struct Heap {
  Surroundings surroundings;
  Vec3 at_world;
  std::list<Thing> things;
  std::vector<Entry> entries;
};

/// Sets the surfaces of a saved map. Throws Error if an object would enter in unknown space: the border of
/// unknown space does not stop what comes from behind it.
void take_map(const std::string& folder, Heap& heap) {
  const SavedMap map = load_map(folder);
  const UnknownSurface unknown =
      map.unknown.load() ? *map.unknown.load() : unknown_surface(map.octree.load(), map.mesh);
  for (const Entry& entry : heap.entries)
    for (const Eigen::Vector3f& v : entry.thing->mesh.vertices)
      if (is_unknown(unknown, entry.T_world_object * (entry.thing->mesh.origin + v.cast<double>())))
        throw Error(
            "--at: an object would enter in space that was not scanned; choose a lower point or another");
  heap.surroundings = {map.mesh, unknown.mesh_world};
}

Heap make_heap(const Options& options) {
  Heap heap;
  const Room table = make_room("table");
  heap.at_world = options.map.empty() ? table.focus_world : options.at_world;
  std::mt19937 random(options.seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < options.objects; ++i) {
    const double size_m = 0.05 + 0.1 * unit(random);
    const int kind = i % 4;
    heap.things.emplace_back("object", kind == 0   ? box_mesh(Vec3::Constant(size_m))
                                       : kind == 1 ? box_mesh({size_m, 0.6 * size_m, 0.3 * size_m})
                                       : kind == 2 ? ball_mesh(0.5 * size_m, 8)
                                                   : utah_teapot(10, size_m));
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = heap.at_world + Vec3(0.17 * (i % 3 - 1) + 0.03 * (unit(random) - 0.5),
                                           0.17 * (i / 3 % 3 - 1) + 0.03 * (unit(random) - 0.5), 0.9);
    heap.entries.push_back({&heap.things.back(), kind != 3, 2 * i + 1, T});
  }
  if (options.map.empty())
    heap.surroundings.room = room_mesh(table);
  else
    take_map(options.map, heap);
  return heap;
}

struct Crossings {
  int crossed = 0, gone = 0;
  double deepest_m = 0.0;
};

/// Tests the bodies at the end against each other and the room.
Crossings find_crossings(const Heap& heap, const Simulated& result) {
  TriangleTree room_tree;
  room_tree.build_by_place(heap.surroundings.room);
  CyberRadar radar;
  Crossings found;
  const std::vector<Entry>& entries = heap.entries;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    found.gone += !(result.T_world_object[i].translation().z() > heap.at_world.z() - 3.0);
    std::vector<SceneTree> scene{{{&room_tree, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic}};
    for (std::size_t k = 0; k < entries.size(); ++k)
      if (k != i)
        scene.push_back({{&entries[k].thing->tree, result.T_world_object[k]}, SurfaceKind::kObject});
    const double depth_m = overlap_m({&entries[i].thing->tree, result.T_world_object[i]}, scene, radar);
    found.crossed += depth_m > 0.0;
    found.deepest_m = std::max(found.deepest_m, depth_m);
  }
  return found;
}

void measure_heap(const Options& options, nlohmann::json& rows) {
  constexpr int kFrames = 300;
  const Heap heap = make_heap(options);
  std::printf(
      "heap of %d objects, %d frames, wall-clock ms a frame; cpu: mean of all threads\n%-12s %8s %8s %8s %8s "
      "%8s %8s %8s %8s %11s %6s\n",
      options.objects, kFrames, "", "median", "p95", "p99", "mean", "cpu", "entered", "asleep", "crossed",
      "deepest mm", "gone");
  for (const Engine& engine : engines_of(options)) {
    const Simulated result = engine.simulate(heap.surroundings, heap.entries, kFrames);
    const Crossings found = find_crossings(heap, result);
    const test::Times& t = result.frames;
    std::printf("%-12s %8.2f %8.2f %8.2f %8.2f %8.2f %8d %8d %8d %11.2f %6d\n", engine.name,
                t.percentile(0.5), t.percentile(0.95), t.percentile(0.99), t.mean(), result.cpu.mean(),
                result.entered, result.asleep, found.crossed, 1e3 * found.deepest_m, found.gone);
    std::fflush(stdout);
    rows.push_back({{"table", "heap"},
                    {"engine", engine.name},
                    {"median_ms", t.percentile(0.5)},
                    {"p95_ms", t.percentile(0.95)},
                    {"p99_ms", t.percentile(0.99)},
                    {"mean_ms", t.mean()},
                    {"cpu_ms", result.cpu.mean()},
                    {"entered", result.entered},
                    {"asleep", result.asleep},
                    {"crossed", found.crossed},
                    {"deepest_mm", 1e3 * found.deepest_m},
                    {"gone", found.gone}});
  }
}

void measure_throws(const Options& options, nlohmann::json& rows) {
  const int throws = options.throws;
  constexpr int kFrames = 120;
  const Thing cube("cube", box_mesh({0.1, 0.1, 0.1})), plate("plate", box_mesh({0.2, 0.2, 0.004})),
      needle("needle", box_mesh({0.002, 0.002, 0.2})), ball("ball", ball_mesh(0.05, 8));
  const std::array<const Thing*, 4> things = {&cube, &plate, &needle, &ball};
  std::printf("%d throws at up to 10 m/s, 4 s each\n%-12s %-7s %8s %8s %8s\n", throws, "", "thing", "throws",
              "outside", "mean ms");
  for (const Engine& engine : engines_of(options)) {
    std::array<int, 4> outside{}, count{};
    std::array<test::Times, 4> times;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::normal_distribution<double> normal;
    const auto direction = [&] { return Vec3(normal(random), normal(random), normal(random)).normalized(); };
    for (const char* name : {"table", "shelf", "wall"}) {
      const Room room = make_room(name);
      const Surroundings surroundings{room_mesh(room), {}};
      const Vec3 low = room.interior_min_world, size = room.interior_max_world - low;
      for (int number = 0; number < throws / 3; ++number) {
        const std::size_t which = static_cast<std::size_t>(number) % things.size();
        Entry entry{things[which], true, 0, Eigen::Isometry3d::Identity()};
        // High above the furniture, away from walls and ceiling.
        entry.T_world_object.rotate(Eigen::AngleAxisd(2.0 * M_PI * unit(random), direction()));
        entry.T_world_object.pretranslate(
            low + Vec3(0.2 + 0.6 * unit(random), 0.2 + 0.6 * unit(random), 0.8).cwiseProduct(size));
        entry.velocity_world_mps = 10.0 * unit(random) * direction();
        entry.angular_velocity_world_rad_s = 20.0 * unit(random) * direction();
        const Simulated result = engine.simulate(surroundings, {entry}, kFrames);
        const Vec3 centre = result.T_world_object[0] * things[which]->mass.centre_object;
        outside[which] += !((centre - low).minCoeff() > 0.0 && (low + size - centre).minCoeff() > 0.0);
        ++count[which];
        times[which].samples_ms.push_back(result.cpu.mean());
      }
    }
    for (std::size_t i = 0; i < things.size(); ++i) {
      std::printf("%-12s %-7s %8d %8d %8.3f\n", engine.name, things[i]->name.c_str(), count[i], outside[i],
                  times[i].mean());
      rows.push_back({{"table", "throws"},
                      {"engine", engine.name},
                      {"thing", things[i]->name},
                      {"throws", count[i]},
                      {"outside", outside[i]},
                      {"mean_ms", times[i].mean()}});
    }
    std::fflush(stdout);
  }
}

int run(int argc, char** argv) {
  const Options options = parse(argc, argv);
  std::printf("%s\n", test::processor().c_str());
  nlohmann::json rows = nlohmann::json::array();
  if (options.only.empty() || options.only == "heap") measure_heap(options, rows);
  if (options.only.empty() || options.only == "throws") measure_throws(options, rows);
  test::write_rows(options.json, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar::bench

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("bullet_bench", [&] { return roomradar::bench::run(argc, argv); });
}
