// physics_bench.cpp: virtual objects at rest on noisy depth, thrown about in simulated rooms, and their cost.
//
// usage: physics_bench [--throws N] [--hands N] [--only rest|throws|hands|time] [--json FILE]
//
//   rest    A cube, a teapot, a ball and a plate on a level surface in view of a simulated Kinect with its
//           noise, in three rooms. All surfaces are each frame's depth (`depth`), or the room's mesh plus the
//           detected foreground (`map`). Measures how far the objects move in 300 frames once asleep.
//   throws  N throws (10,000) at up to 10 m/s and 20 rad/s in thirteen rooms. Checked against the rooms'
//           exact solids: every substep of a path is sampled in steps no longer than the solids' clearance.
//           The thrown solids are reduced by 0.9 mm on all sides, since meshes are up to 0.5 mm inside round
//           solids.
//   hands   A hand through N objects (200) on a table at 0.1 to 3 m/s, seen by a simulated Kinect with its
//           noise; see physics_bench_hands.hpp.
//   time    Time per frame with one body of some 6,300 triangles (12 for the cube), from the throw to rest;
//           and of a board that falls flat on another, of 12 and of 10,800 triangles each.
//
// Rooms, objects, seeds and configs are fixed: changing them breaks the comparison with earlier results.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>

#include "app/objects/teapot.hpp"
#include "app/physics/placement/placement.hpp"
#include "app/physics/rigid_motion.hpp"
#include "app/session/frame_scene.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sim/solids/solid_distance.hpp"
#include "bench_times.hpp"
#include "mapping/types/system/error.hpp"
#include "physics_bench_hands.hpp"
#include "physics_bench_scenes.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::bench {
namespace {

using Vec3 = Eigen::Vector3d;
constexpr double kFrame_s = 1.0 / 30.0;

struct Options {
  int throws = 10'000, hands = 200;
  std::string only, json;
  [[nodiscard]] bool wants(const char* table) const { return only.empty() || only == table; }
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    if (i + 1 == argc) throw Error(name + ": has no value");
    if (name == "--throws") {
      options.throws = std::clamp(std::atoi(argv[i + 1]), 1, 10'000'000);
    } else if (name == "--hands") {
      options.hands = std::clamp(std::atoi(argv[i + 1]), 1, 100'000);
    } else if (name == "--only") {
      options.only = argv[i + 1];
    } else if (name == "--json") {
      options.json = argv[i + 1];
    } else {
      throw Error(name + ": not known; there are --throws, --hands, --only and --json");
    }
  }
  return options;
}

double angle_deg(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle() * 180.0 / M_PI;
}

// rest
// ---------------------------------------------------------------------------------------------------------

struct Lying {
  const Thing* thing;
  Body body;
  int at_rest_from = -1;  // frame
  int wakes = 0;
  Eigen::Isometry3d lay = Eigen::Isometry3d::Identity();
  double moved_m = 0.0, turned_deg = 0.0;  // greatest since then
};

void measure_rest(nlohmann::json& rows) {
  constexpr int kSettle = 240, kFrames = 300;
  const Thing cube("cube", box_mesh({0.12, 0.12, 0.12})), pot("teapot", utah_teapot(10, 0.15)),
      ball("ball", ball_mesh(0.04, 23)), plate("plate", box_mesh({0.2, 0.2, 0.01}));
  GlContext context;
  CyberRadar radar;
  std::printf("at rest on noisy depth, %d frames\n%-6s %-6s %-7s %9s %9s %6s %6s\n", kFrames, "room",
              "policy", "thing", "moves mm", "turns deg", "rests", "wakes");
  for (const char* name : {"table", "shelf", "wall"}) {
    SimOptions sim;
    sim.room = name;
    sim.frames = kSettle + kFrames;
    sim.path = CameraPathKind::kView;
    sim.with_colour = false;
    SimulatedSource source(sim);
    Shape room(context);
    room.set(room_mesh(source.room()), MeshUsage::kStatic);
    FrameScene of_depth(context, room, {.surfaces = SurfacePolicy::kHoles});
    FrameScene of_map(context, room, {.surfaces = SurfacePolicy::kMap});
    std::array<std::vector<Lying>, 2> lying;
    Frame frame;
    for (int i = 0; source.next(frame).status == ReadStatus::kFrame; ++i) {
      const Eigen::Isometry3d& T_world_camera = *frame.T_world_camera;
      if (i == 0) {
        const Support support = find_support(frame.depth_m, frame.depth_camera, T_world_camera, {0.12});
        if (!support) throw Error(std::string(name) + ": no level surface in view");
        for (const Thing* thing : {&cube, &pot, &ball, &plate}) {
          for (auto& of_policy : lying) {
            Lying& one = of_policy.emplace_back();
            one.thing = thing;
            one.body.mass = thing->mass;
            one.body.T_world_object.translation() =
                support.point_world + Vec3(0, 0, 0.1 + thing->mass.radius_m);
          }
        }
      }
      of_depth.mesh_all_pixels(frame, T_world_camera);
      const ExpectedView& expected = of_map.render_expected(frame.depth_camera, T_world_camera);
      of_map.mesh_surfaces(frame, T_world_camera, expected, of_map.find_dynamic(frame, expected));
      for (std::size_t policy = 0; policy < 2; ++policy) {
        const std::vector<SceneTree> surfaces = policy == 0 ? of_depth.surfaces() : of_map.surfaces();
        const RadarScene scene{surfaces, {}};
        for (Lying& one : lying[policy]) {
          const StepReport report =
              advance(one.body, kFrame_s, make_collision_queries(radar, one.thing->tree, scene), {});
          if (one.body.asleep && one.at_rest_from < 0) one.at_rest_from = i;
          if (i < kSettle) continue;
          if (i == kSettle) one.lay = one.body.T_world_object;
          one.wakes += report.woke;
          one.moved_m = std::max(one.moved_m, (one.body.T_world_object * one.thing->mass.centre_object -
                                               one.lay * one.thing->mass.centre_object)
                                                  .norm());
          one.turned_deg = std::max(one.turned_deg, angle_deg(one.lay, one.body.T_world_object));
        }
      }
    }
    for (std::size_t policy = 0; policy < 2; ++policy) {
      for (const Lying& one : lying[policy]) {
        const char* policy_name = policy == 0 ? "depth" : "map";
        std::printf("%-6s %-6s %-7s %9.3f %9.3f %6d %6d\n", name, policy_name, one.thing->name.c_str(),
                    1e3 * one.moved_m, one.turned_deg, one.at_rest_from, one.wakes);
        rows.push_back({{"table", "rest"},
                        {"room", name},
                        {"policy", policy_name},
                        {"thing", one.thing->name},
                        {"moves_mm", 1e3 * one.moved_m},
                        {"turns_deg", one.turned_deg},
                        {"at_rest_from_frame", one.at_rest_from},
                        {"wakes", one.wakes}});
      }
    }
  }
}

// throws
// -------------------------------------------------------------------------------------------------------

struct Thrown {
  Thing thing;
  Solid solid;  ///< the same shape, reduced by 0.9 mm on all sides
};

std::vector<Thrown> thrown_things() {
  constexpr double kSmaller_m = 0.9e-3;
  std::vector<Thrown> things;
  const auto add_box = [&](const char* name, const Vec3& size_m) {
    things.push_back(
        {Thing(name, box_mesh(size_m)), box(Vec3::Zero(), size_m - Vec3::Constant(2.0 * kSmaller_m))});
  };
  add_box("cube", {0.1, 0.1, 0.1});
  add_box("plate", {0.2, 0.2, 0.004});
  add_box("needle", {0.002, 0.002, 0.2});
  add_box("box", {0.3, 0.08, 0.16});
  things.push_back({Thing("ball", ball_mesh(0.05, 8)), sphere(Vec3::Zero(), 0.05 - kSmaller_m)});
  return things;
}

/// Returns true if the solid overlaps an obstacle. An overlap counts only if it persists when the solid is
/// shifted and rotated slightly: in some exactly aligned poses the distance of two solids is computed as 0.
bool is_in_any(const std::vector<Solid>& obstacles, const Solid& solid,
               const Eigen::Isometry3d& T_world_object) {
  constexpr double kHair = 2e-5;
  for (const Vec3& by : {Vec3(1, 0.3, -0.2), Vec3(-0.4, 1, 0.5), Vec3(0.2, -0.6, 1), Vec3(-1, -0.7, -0.9)}) {
    Eigen::Isometry3d beside = T_world_object;
    beside.pretranslate(kHair * by);
    beside.rotate(Eigen::AngleAxisd(kHair, by.cross(Vec3(0.3, 0.5, 0.8)).normalized()));
    if (clearance_m(obstacles, {&solid, 1}, beside, 0.1) > 0.0) return false;
  }
  return true;
}

/// Returns true if the solid hits an obstacle on its path; tests poses as far apart as its clearance allows.
bool meets_any(const std::vector<Solid>& obstacles, const Solid& solid,
               const Eigen::Isometry3d& T_world_object, const RigidMotion& motion, double duration_s,
               double radius_m) {
  constexpr double kLeast_m = 2e-4, kEnough_m = 0.5;
  const double fastest_mps = motion.linear_m_s.norm() + motion.angular_rad_s.norm() * radius_m;
  for (double t = 0.0;;) {
    const double clear_m =
        clearance_m(obstacles, {&solid, 1}, pose_after(T_world_object, motion, t), kEnough_m);
    if (clear_m <= 0.0 && is_in_any(obstacles, solid, pose_after(T_world_object, motion, t))) return true;
    if (t >= duration_s) return false;
    t = fastest_mps > 0.0 ? std::min(duration_s, t + std::max(clear_m, kLeast_m) / fastest_mps) : duration_s;
  }
}

void measure_throws(int throws, nlohmann::json& rows) {
  const std::vector<Thrown> things = thrown_things();
  struct Place {
    Room room;
    TriangleTree tree;
  };
  std::vector<Place> places;
  for (const std::string& name : room_names()) places.push_back({make_room(name), {}});
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    places.push_back({make_room(kRandomRoom, false, seed), {}});
  for (Place& place : places) place.tree.build_by_place(room_mesh(place.room));
  CyberRadar radar;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return Vec3(normal(random), normal(random), normal(random)).normalized(); };
  struct Total {
    int throws = 0, tunnelled = 0, outside = 0, asleep = 0, not_finite = 0;
    double most_gain_j_kg = -1e300;
  };
  std::vector<Total> totals(things.size());
  PhysicsConfig config;
  config.restitution = 0.4;
  for (int number = 0; number < throws; ++number) {
    const std::size_t which = static_cast<std::size_t>(number) % things.size();
    const Place& place = places[(static_cast<std::size_t>(number) / things.size()) % places.size()];
    const auto& [thing, solid] = things[which];
    Total& total = totals[which];
    Body body;
    body.mass = thing.mass;
    const Vec3 low = place.room.interior_min_world, size = place.room.interior_max_world - low;
    do {
      body.T_world_object = Eigen::Isometry3d::Identity();
      body.T_world_object.rotate(Eigen::AngleAxisd(2.0 * M_PI * unit(random), direction()));
      body.T_world_object.pretranslate(low +
                                       Vec3(unit(random), unit(random), unit(random)).cwiseProduct(size));
    } while (clearance_m(place.room.solids, {&solid, 1}, body.T_world_object, 0.05) < 0.05);
    body.velocity_world_mps = 10.0 * unit(random) * direction();
    body.angular_velocity_world_rad_s = 20.0 * unit(random) * direction();
    const double energy_before = energy_of(body, config);
    const SceneTree tree{{&place.tree, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
    const RadarScene scene{{&tree, 1}, {}};
    CollisionQueries probe = make_collision_queries(radar, thing.tree, scene);
    bool tunnelled = false;
    Vec3 met_world = Vec3::Zero();
    Eigen::Isometry3d T_followed = body.T_world_object;
    const auto follow = [&](const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                            double duration_s) {
      if (tunnelled) return;
      tunnelled =
          meets_any(place.room.solids, solid, T_world_object, motion, duration_s, thing.mass.radius_m);
      if (tunnelled) met_world = T_world_object.translation();
      T_followed = pose_after(T_world_object, motion, duration_s);
    };
    // A depenetration shift between two substeps is a straight translation.
    const auto follow_to = [&](const Eigen::Isometry3d& T_world_object) {
      RigidMotion shift;
      shift.linear_m_s = T_world_object.translation() - T_followed.translation();
      if (shift.linear_m_s.norm() > 1e-9) follow(T_followed, shift, 1.0);
    };
    probe.free_time = [&, ask = probe.free_time](const Eigen::Isometry3d& T_world_object,
                                                 const RigidMotion& motion, double duration_s, double keep_m,
                                                 SurfaceKindMask left_out, const TreeStates& trees) {
      const FreeTime free = ask(T_world_object, motion, duration_s, keep_m, left_out, trees);
      follow_to(T_world_object);
      follow(T_world_object, motion, free.free_s);
      return free;
    };
    for (int frame = 0; frame < 120 && !body.asleep; ++frame) {
      (void)advance(body, kFrame_s, probe, config);
      total.most_gain_j_kg = std::max(total.most_gain_j_kg, energy_of(body, config) - energy_before);
    }
    follow_to(body.T_world_object);
    const Vec3 centre = centre_world(body);
    if (tunnelled) {
      std::printf("throw %d, a %s in %s: in a solid at %.3f %.3f %.3f m\n", number, thing.name.c_str(),
                  place.room.name.c_str(), met_world.x(), met_world.y(), met_world.z());
    }
    ++total.throws;
    total.tunnelled += tunnelled || is_in_any(place.room.solids, solid, body.T_world_object);
    total.outside += !((centre - low).minCoeff() > 0.0 && (low + size - centre).minCoeff() > 0.0);
    total.asleep += body.asleep;
    total.not_finite += !body.T_world_object.matrix().allFinite();
  }
  std::printf("throws at up to 10 m/s in %zu rooms\n%-7s %7s %9s %8s %12s %14s\n", places.size(), "thing",
              "throws", "tunnelled", "outside", "rest in 4 s", "energy gained");
  for (std::size_t i = 0; i < things.size(); ++i) {
    const Total& total = totals[i];
    std::printf("%-7s %7d %9d %8d %12d %14.2g\n", things[i].thing.name.c_str(), total.throws, total.tunnelled,
                total.outside, total.asleep, total.most_gain_j_kg);
    rows.push_back({{"table", "throws"},
                    {"thing", things[i].thing.name},
                    {"throws", total.throws},
                    {"tunnelled", total.tunnelled},
                    {"outside", total.outside},
                    {"not_finite", total.not_finite},
                    {"at_rest", total.asleep},
                    {"energy_gained_j_kg", total.most_gain_j_kg}});
  }
}

// time
// ---------------------------------------------------------------------------------------------------------

void measure_time(nlohmann::json& rows) {
  constexpr int kThrows = 60, kFrames = 120;
  const Thing cube("cube", box_mesh({0.12, 0.12, 0.12})), pot("teapot", utah_teapot(10, 0.15)),
      ball("ball", ball_mesh(0.05, 23));
  std::printf("time of a frame, one body, thread time\n%-7s %9s %8s %10s %8s %8s %8s\n", "thing", "triangles",
              "frames", "which", "median", "p95", "max ms");
  for (const Thing* thing : {&cube, &ball, &pot}) {
    test::Times all, awake;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (const std::string& name : room_names()) {
      const Room room = make_room(name);
      World world;
      world.add(room_mesh(room));
      for (int number = 0; number < kThrows; ++number) {
        Body body;
        body.mass = thing->mass;
        body.T_world_object.translation() = room.focus_world + Vec3(0, 0, 0.5);
        body.T_world_object.rotate(
            Eigen::AngleAxisd(3.0 * unit(random), Vec3(unit(random), unit(random), 1).normalized()));
        body.velocity_world_mps = 1.5 * Vec3(unit(random), unit(random), unit(random));
        body.angular_velocity_world_rad_s = 5.0 * Vec3(unit(random), unit(random), unit(random));
        for (int frame = 0; frame < kFrames; ++frame) {
          const bool was_awake = !body.asleep;
          const double start = test::thread_ms();
          (void)world.step(body, *thing, kFrame_s, {});
          const double ms = test::thread_ms() - start;
          all.samples_ms.push_back(ms);
          if (was_awake) awake.samples_ms.push_back(ms);
        }
      }
    }
    for (auto* times : {&all, &awake}) {
      const char* which = times == &all ? "all" : "awake";
      const std::size_t frames = times->samples_ms.size();
      const double median = times->percentile(0.5), p95 = times->percentile(0.95),
                   most = times->percentile(1.0);
      std::printf("%-7s %9zu %8zu %10s %8.3f %8.3f %8.3f\n", thing->name.c_str(),
                  thing->tree.triangle_count(), frames, which, median, p95, most);
      rows.push_back({{"table", "time"},
                      {"thing", thing->name},
                      {"triangles", thing->tree.triangle_count()},
                      {"frames", which},
                      {"median_ms", median},
                      {"p95_ms", p95},
                      {"max_ms", most}});
    }
  }
}

void measure_boards(nlohmann::json& rows) {
  constexpr int kFalls = 10, kFrames = 120;
  std::printf("time of a frame, a board falls flat on another, thread time\n%9s %8s %8s %8s %8s\n",
              "triangles", "frames", "median", "p95", "max ms");
  for (const int cells : {1, 30}) {
    const Mesh board = shapes::box_of_cells({0.3F, 0.2F, 0.02F}, cells);
    const Thing thing("board", board);
    test::Times awake;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int fall = 0; fall < kFalls; ++fall) {
      World world;
      world.add(board, SurfaceKind::kObject);
      Body body;
      body.mass = thing.mass;
      body.T_world_object.translation() = Vec3(0.03 * unit(random), 0.03 * unit(random), 0.06);
      body.T_world_object.rotate(
          Eigen::AngleAxisd(0.1 * unit(random), Vec3(unit(random), unit(random), 1.0).normalized()));
      for (int frame = 0; frame < kFrames && !body.asleep; ++frame) {
        const double start = test::thread_ms();
        (void)world.step(body, thing, kFrame_s, {});
        awake.samples_ms.push_back(test::thread_ms() - start);
      }
      if (!body.asleep || std::abs(body.T_world_object.translation().z() - 0.02) > 2e-3)
        throw Error("board " + std::to_string(fall) + ": does not lie on the other after 4 s");
    }
    const double median = awake.percentile(0.5), p95 = awake.percentile(0.95), most = awake.percentile(1.0);
    std::printf("%9zu %8zu %8.3f %8.3f %8.3f\n", thing.tree.triangle_count(), awake.samples_ms.size(), median,
                p95, most);
    rows.push_back({{"table", "boards"},
                    {"triangles", thing.tree.triangle_count()},
                    {"frames", awake.samples_ms.size()},
                    {"median_ms", median},
                    {"p95_ms", p95},
                    {"max_ms", most}});
  }
}

int run(int argc, char** argv) {
  const Options options = parse(argc, argv);
  nlohmann::json rows = nlohmann::json::array();
  if (options.wants("time")) measure_time(rows);
  if (options.wants("time")) measure_boards(rows);
  if (options.wants("rest")) measure_rest(rows);
  if (options.wants("throws")) measure_throws(options.throws, rows);
  if (options.wants("hands")) measure_hands(options.hands, rows);
  test::write_rows(options.json, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar::bench

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("physics_bench", [&] { return roomradar::bench::run(argc, argv); });
}
