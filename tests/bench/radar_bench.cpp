// radar_bench.cpp: time and error of Cyber Radar on a scene that is new in every frame, beside FCL and
// Embree.
//
// The depth frame, the poses and the seeds are fixed: changing them breaks the comparison with earlier
// results. Needs only roomradar's radar and types. Omits OpenGL's rows without an EGL device, and a peer's
// rows if its module is not beside the program.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "mapping/types/system/error.hpp"
#include "radar_bench_objects.hpp"
#include "radar_bench_rows.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/support/exact_travel.hpp"

namespace roomradar::bench {
namespace {

constexpr double kDistance_m = 0.5;  // d is this plus the sensor's length
constexpr double kClear_m = 0.15;  // no sensor of the frame's table reaches farther than 0.13 from its centre
constexpr const char* kUsage =
    "usage: radar_bench [--json FILE] [--poses N] [--concave N] [--bounds N] [--objects N] [--only TABLE]\n"
    "  --poses N    free poses of the tables `frame` and `steady` (24)\n"
    "  --concave N  free poses of a torus, a cup and a chair with a stick in the hollow (3000)\n"
    "  --bounds N   poses of all objects, hollow ones too, that exact answers and bounds are judged on "
    "(3000)\n"
    "  --objects N  virtual objects that ask once each a frame (1000)\n"
    "  --only T     one table: frame, steady, concave, bounds or objects\n";

struct Options {
  std::string json_path, only;
  int poses = 24, concave = 3000, bounds = 3000, objects = 1000;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    if (i + 1 == argc) throw Error(name + ": has no value\n" + kUsage);
    const auto count = [&] { return std::clamp(std::atoi(argv[i + 1]), 1, 1'000'000); };
    if (name == "--json") {
      options.json_path = argv[i + 1];
    } else if (name == "--only") {
      options.only = argv[i + 1];
    } else if (name == "--poses") {
      options.poses = count();
    } else if (name == "--concave") {
      options.concave = count();
    } else if (name == "--bounds") {
      options.bounds = count();
    } else if (name == "--objects") {
      options.objects = count();
    } else {
      throw Error(name + ": not known\n" + kUsage);
    }
  }
  return options;
}

std::vector<std::optional<double>> exact_travels(const Mesh& sensor, const std::vector<Pose>& poses,
                                                 const Mesh& scene) {
  std::vector<std::optional<double>> exact_m;
  for (const Pose& pose : poses) {
    exact_m.push_back(exact_travel(sensor, pose.T_world_sensor, pose.direction_world, kDistance_m, scene,
                                   Eigen::Isometry3d::Identity()));
  }
  return exact_m;
}

void print_head() {
  std::printf("%9s %8s %-19s %4s | %9s %9s %9s | %9s %9s | %5s %6s %6s | %8s %9s\n", "scene", "sensor",
              "method", "px", "median ms", "p95 ms", "cpu ms", "err med", "err max", "false", "missed",
              "bounds", "FCL:this", "Embree:it");
}

std::string milliseconds(double ms) {
  char text[32] = "-";  // not timed
  if (ms > 0.0) std::snprintf(text, sizeof text, "%.3f", ms);
  return text;
}

void print(const Row& r, double fcl_ms, double embree_ms) {
  std::printf("%9zu %8zu %-19s %4d | %9s %9s %9s | %6.4f mm %6.3f mm | %5d %6d %6s |", r.scene_triangles,
              r.sensor_triangles, r.method.c_str(), r.radar_px, milliseconds(r.median_ms).c_str(),
              milliseconds(r.p95_ms).c_str(), milliseconds(r.cpu_median_ms).c_str(), 1e3 * r.error_median_m,
              1e3 * r.error_max_m, r.false_contacts, r.missed,
              r.gives_bounds ? std::to_string(r.wrong_bounds).c_str() : "-");
  for (const double peer_ms : {fcl_ms, embree_ms}) {
    if (peer_ms > 0.0 && r.cpu_median_ms > 0.0) std::printf(" %9.2f", peer_ms / r.cpu_median_ms);
  }
  std::printf("\n");
  std::fflush(stdout);
}

/// All methods side by side; the scene is new and the sensor rotated in every pose.
void frame_table(const FrameScene& frame, const std::vector<Pose>& poses, GlContext* context,
                 const std::vector<std::unique_ptr<Peer>>& peers, std::vector<Row>& rows) {
  for (const Sensor& sensor : sensors()) {
    std::vector<Method> methods;
    for (const auto& peer : peers) methods.push_back(peer_on_depth(*peer, frame, sensor.mesh, kDistance_m));
    for (const int px : {64, 128, 256}) {
      for (const RadarMode mode : {RadarMode::kExact, RadarMode::kSampled}) {
        methods.push_back(radar_on_depth(frame, sensor.mesh, mode, px, kDistance_m));
      }
    }
    methods.push_back(radar_on_mesh(frame, sensor.mesh, RadarMode::kExact, 64, kDistance_m));
    if (context != nullptr) {
      for (const int px : {64, 128, 256}) {
        methods.push_back(gl_radar_on_mesh(*context, frame, sensor.mesh, px, kDistance_m));
      }
    }
    std::vector<Row> cell = measure(methods, poses, exact_travels(sensor.mesh, poses, frame.mesh));
    const auto time_of = [&](const char* peer) {
      const auto found =
          std::find_if(cell.begin(), cell.end(), [&](const Row& row) { return row.method == peer; });
      return found == cell.end() ? 0.0 : found->cpu_median_ms;
    };
    for (Row& row : cell) {
      row.table = "frame";
      row.scene_triangles = frame.mesh.triangles.size();
      row.sensor_triangles = sensor.mesh.triangles.size();
      print(row, time_of("FCL"), time_of("Embree"));
      rows.push_back(row);
    }
  }
}

/// The scene is new, and the object has moved but not rotated: shows whether its triangle count still
/// matters.
void steady_table(const FrameScene& frame, const std::vector<Pose>& poses, std::vector<Row>& rows) {
  constexpr int kUntilSteady = 200;  // queries until M reaches its final resolution
  std::vector<Sensor> all = sensors();
  all.insert(all.begin() + 1, torus_sized_box());
  for (const int px : {64, 128, 256}) {
    std::vector<Row> cell;
    for (const RadarMode mode : {RadarMode::kExact, RadarMode::kSampled}) {
      for (const Sensor& sensor : all) {
        Row row = measure({radar_on_depth(frame, sensor.mesh, mode, px, kDistance_m)}, poses,
                          exact_travels(sensor.mesh, poses, frame.mesh), kUntilSteady)
                      .front();
        row.table = "steady";
        row.method += ", " + sensor.name;
        row.scene_triangles = frame.mesh.triangles.size();
        row.sensor_triangles = sensor.mesh.triangles.size();
        print(row, 0.0, 0.0);
        cell.push_back(row);
        rows.push_back(row);
      }
      const double fine_ms = cell.back().cpu_median_ms;
      std::printf(
          "%9s %8s time(181,412) : time(12) at %d px: %.2f of the cube, %.2f of the box of its size\n", "",
          "", px, fine_ms / cell[cell.size() - 4].cpu_median_ms,
          fine_ms / cell[cell.size() - 3].cpu_median_ms);
    }
  }
}

/// Checks both modes of the CPU radar, and the GL radar, on poses of one object in one scene. Not timed.
void judge_modes(const std::string& table, const Sensor& sensor, const std::vector<Pose>& poses,
                 const Mesh& scene, GlContext* context, std::vector<Row>& rows) {
  FrameScene as_frame;  // only its mesh is used
  as_frame.mesh = scene;
  std::vector<Method> methods = {radar_on_mesh(as_frame, sensor.mesh, RadarMode::kExact, 64, kDistance_m),
                                 radar_on_mesh(as_frame, sensor.mesh, RadarMode::kSampled, 64, kDistance_m),
                                 radar_on_mesh(as_frame, sensor.mesh, RadarMode::kSampled, 128, kDistance_m)};
  if (context != nullptr)
    methods.push_back(gl_radar_on_mesh(*context, as_frame, sensor.mesh, 128, kDistance_m));
  const std::vector<std::optional<double>> exact_m = exact_travels(sensor.mesh, poses, scene);
  for (const Method& method : methods) {
    Row row{.table = table, .method = method.name + ", " + sensor.name};
    row.scene_triangles = scene.triangles.size();
    row.sensor_triangles = sensor.mesh.triangles.size();
    row.radar_px = method.radar_px;
    row.gives_bounds = method.gives_bounds;
    std::vector<double> error_m;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (const auto error = judge(method.query(poses[i]), exact_m[i], row)) error_m.push_back(*error);
    }
    add_errors(error_m, row);
    print(row, 0.0, 0.0);
    rows.push_back(row);
  }
}

/// Free poses of concave objects with scene in the hollow: any contact reported before the true one is false.
void concave_table(int count, GlContext* context, std::vector<Row>& rows) {
  std::vector<Eigen::Vector3d> tips_m;
  const Mesh sticks = sticks_mesh(60, 3, tips_m);
  const std::vector<Sensor> all = concave_sensors();
  for (const Sensor& sensor : all) {
    const auto share = static_cast<int>((count + all.size() - 1) / all.size());
    judge_modes("concave", sensor, hollow_poses(sensor.mesh, sticks, tips_m, share, 5), sticks, context,
                rows);
  }
}

/// Checks that lower_m <= truth <= upper_m, and that the exact result is exact.
void bounds_table(int count, const FrameScene& coarse, const FrameScene& fine, std::vector<Row>& rows) {
  const int share = (count + 5) / 6;
  const std::vector<Pose> poses = free_poses(coarse, fine, kClear_m, share);
  for (const Sensor& sensor : sensors()) judge_modes("bounds", sensor, poses, coarse.mesh, nullptr, rows);
  std::vector<Eigen::Vector3d> tips_m;
  const Mesh sticks = sticks_mesh(60, 17, tips_m);
  for (const Sensor& sensor : concave_sensors()) {
    judge_modes("bounds", sensor, hollow_poses(sensor.mesh, sticks, tips_m, share, 23), sticks, nullptr,
                rows);
  }
}

int run(int argc, char** argv) {
  const Options options = parse(argc, argv);
  std::unique_ptr<GlContext> context;
  std::string without_gl;
  try {
    context = std::make_unique<GlContext>();
  } catch (const Error& error) {
    without_gl = error.what();
  }
  std::printf("%s, %ld cores; %s; compiler %s, flags %s\n", test::processor().c_str(),
              sysconf(_SC_NPROCESSORS_ONLN), context ? context->renderer().c_str() : "no GL", __VERSION__,
              ROOMRADAR_FLAGS);
  if (!context) std::printf("OpenGL's rows are left out: %s\n", without_gl.c_str());
  std::vector<std::string> missing;
  const std::vector<std::unique_ptr<Peer>> peers = load_peers(missing);
  for (const std::string& line : missing) std::printf("%s\n", line.c_str());
  std::printf(
      "%d free poses, %.1f m ahead; from a new depth image (`mesh`, `GL`: new triangles) to the answer;\n"
      "median and p95: wall clock; cpu and ratios: the calling thread's own time; bounds: answers whose "
      "bounds do "
      "not hold\n",
      options.poses, kDistance_m);
  const FrameScene coarse = table_frame(4), fine = table_frame(1);
  std::vector<Row> rows;
  const auto is_wanted = [&](const char* table) {
    const bool is = options.only.empty() || options.only == table;
    if (is) {
      std::printf("\n%s\n", table);
      print_head();
    }
    return is;
  };
  if (is_wanted("frame")) {
    const std::vector<Pose> poses = free_poses(coarse, fine, kClear_m, options.poses);
    for (const FrameScene* frame : {&coarse, &fine}) frame_table(*frame, poses, context.get(), peers, rows);
  }
  if (is_wanted("steady")) {
    constexpr double kBoxClear_m = 0.2;  // the box's corners are 0.18 from its centre
    const std::vector<Pose> poses = steady_poses(coarse, fine, kBoxClear_m, options.poses);
    for (const FrameScene* frame : {&coarse, &fine}) steady_table(*frame, poses, rows);
  }
  if (is_wanted("concave")) concave_table(options.concave, context.get(), rows);
  if (is_wanted("bounds")) bounds_table(options.bounds, coarse, fine, rows);
  if (is_wanted("objects")) {
    for (const RadarMode mode : {RadarMode::kExact, RadarMode::kSampled}) {
      rows.push_back(measure_objects(coarse, options.objects, 64, mode));
      print(rows.back(), 0.0, 0.0);
    }
    if (context) {
      rows.push_back(measure_objects_gl(*context, coarse, options.objects, 64));
      print(rows.back(), 0.0, 0.0);
    }
  }
  if (!options.json_path.empty()) write_json(options.json_path, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar::bench

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("radar_bench", [&] { return roomradar::bench::run(argc, argv); });
}
