// radar_bench.cpp: time and error of Cyber Radar on a scene that is new every frame.
//
// Fixed: the depth frame, the poses, the seeds. Changing any of them breaks comparison with old numbers.
// Needs roomradar's radar and types only. Usage: radar_bench [--json FILE] [--poses N]
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "mapping/types/error.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/exact_travel.hpp"
#include "radar/gl_radar.hpp"

namespace roomradar {
namespace {

constexpr double kDistance_m = 0.5;  // d is this plus the sensor's length
constexpr Intrinsics kCamera{640, 480, 585.0, 585.0, 319.5, 239.5};

/// Depth of a table with things on it before a wall, as from a hand-held sensor, with a little noise.
DepthImage depth_frame() {
  DepthImage depth_m(kCamera.width_px, kCamera.height_px);
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  struct Ball {
    Eigen::Vector3d centre;
    double radius_m;
  };
  const std::vector<Ball> balls = {{{-0.35, 0.25, 1.3}, 0.12},
                                   {{0.15, 0.3, 1.1}, 0.08},
                                   {{0.4, 0.15, 1.6}, 0.2},
                                   {{-0.1, 0.1, 1.9}, 0.25},
                                   {{-0.6, 0.2, 1.8}, 0.15}};
  const double tilt = 0.6;  // the camera looks down on the table by this much
  const Eigen::Vector3d up(0, -std::cos(tilt), -std::sin(tilt));
  for (int v = 0; v < kCamera.height_px; ++v) {
    for (int u = 0; u < kCamera.width_px; ++u) {
      const Eigen::Vector3d ray = back_project(kCamera, u, v, 1.0);
      double z_m = 3.0 / (1.0 + 0.3 * ray.x());  // wall
      const double down = -up.dot(ray);
      if (down > 1e-6) z_m = std::min(z_m, (1.2 + 0.01 * std::sin(20.0 * ray.x())) / down);  // table
      for (const Ball& ball : balls) {
        const double a = ray.squaredNorm(), b = ray.dot(ball.centre);
        const double c = ball.centre.squaredNorm() - ball.radius_m * ball.radius_m;
        if (b * b > a * c) z_m = std::min(z_m, (b - std::sqrt(b * b - a * c)) / a);
      }
      depth_m.at(u, v) = static_cast<float>(z_m + 0.001 * noise(random));
    }
  }
  return depth_m;
}

/// Two triangles a cell of stride x stride pixels, none across a jump of more than 5 cm.
Mesh frame_mesh(const DepthImage& depth_m, int stride) {
  Mesh mesh;
  const int columns = (depth_m.width - 1) / stride + 1, rows = (depth_m.height - 1) / stride + 1;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int u = i * stride, v = j * stride;
      mesh.vertices.push_back(back_project(kCamera, u, v, depth_m.at(u, v)).cast<float>());
    }
  }
  const auto add = [&](int a, int b, int c) {
    const auto [low, high] = std::minmax({mesh.vertices[a].z(), mesh.vertices[b].z(), mesh.vertices[c].z()});
    if (high - low > 0.05F) return;
    mesh.triangles.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  };
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const int at = j * columns + i;
      add(at, at + columns, at + columns + 1);  // counter-clockwise seen from the camera (y down)
      add(at, at + columns + 1, at + 1);
    }
  }
  return mesh;
}

Mesh cube(float side_m) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) != 0 ? side_m / 2 : -side_m / 2,
                               (i & 2) != 0 ? side_m / 2 : -side_m / 2,
                               (i & 4) != 0 ? side_m / 2 : -side_m / 2);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// 2 * around * across triangles.
Mesh bumpy_torus(int around, int across) {
  Mesh mesh;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = kTurn * i / around, b = kTurn * j / across;
      const double tube_m = 0.035 + 0.01 * std::sin(7.0 * a) * std::sin(5.0 * b);
      const double r_m = 0.08 + tube_m * std::cos(b);
      mesh.vertices.push_back(
          Eigen::Vector3d(r_m * std::cos(a), r_m * std::sin(a), tube_m * std::sin(b)).cast<float>());
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % around) * across + j % across);
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

struct Pose {
  Eigen::Isometry3d T_world_sensor;
  Eigen::Vector3d direction_world;
};

/// Free poses about 15 to 40 cm before a surface, moving roughly away from the camera.
std::vector<Pose> free_poses(const Mesh& scene, const DepthImage& depth_m, int count) {
  constexpr double kClear_m = 0.13;  // no sensor reaches farther from its middle
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<Pose> poses;
  while (static_cast<int>(poses.size()) < count) {
    const int u = 320 + static_cast<int>(220.0 * uniform(random)),
              v = 260 + static_cast<int>(150.0 * uniform(random));
    const Eigen::Vector3d surface = back_project(kCamera, u, v, depth_m.at(u, v));
    const Eigen::Vector3d centre = surface - (0.275 + 0.125 * uniform(random)) * surface.normalized();
    const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    Pose pose;
    pose.T_world_sensor = Eigen::Translation3d(centre) * Eigen::Quaterniond(w, x, y, z).normalized();
    const double dx = uniform(random), dy = uniform(random), dz = uniform(random);
    pose.direction_world = surface.normalized() + 0.5 * Eigen::Vector3d(dx, dy, dz);
    const bool is_free = std::none_of(
        scene.vertices.begin(), scene.vertices.end(),
        [&](const Eigen::Vector3f& p) { return (p.cast<double>() - centre).norm() < kClear_m + 0.02; });
    if (is_free) poses.push_back(pose);
  }
  return poses;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(q * static_cast<double>(values.size() - 1)))];
}

struct Row {
  std::size_t scene_triangles = 0, sensor_triangles = 0;
  int radar_px = 0;
  double median_ms = 0, p95_ms = 0, upload_median_ms = 0;
  double error_median_m = 0, error_max_m = 0, early_max_m = 0, pixel_m = 0;
  int contacts = 0, false_contacts = 0, missed = 0;
};

Row measure(GlContext& context, const Mesh& scene, const Mesh& sensor, const std::vector<Pose>& poses,
            const std::vector<std::optional<double>>& exact_m, int radar_px) {
  using Clock = std::chrono::steady_clock;
  const auto ms = [](Clock::duration t) { return std::chrono::duration<double, std::milli>(t).count(); };
  GlRadar radar(context, {.resolution_px = radar_px});
  GpuMesh scene_gpu(context), sensor_gpu(context);
  sensor_gpu.upload(sensor, MeshUsage::kStatic);
  const SceneMesh scene_mesh{{&scene_gpu, Eigen::Isometry3d::Identity()}, Touched::kDynamic};
  Row row{.scene_triangles = scene.triangles.size(),
          .sensor_triangles = sensor.triangles.size(),
          .radar_px = radar_px};
  std::vector<double> all_ms, upload_ms, late_m;
  constexpr int kWarmUp = 3, kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < poses.size() + (round == 0 ? kWarmUp : 0); ++i) {
      const std::size_t which = i % poses.size();
      const MeshInstance instance{&sensor_gpu, poses[which].T_world_sensor};
      const auto start = Clock::now();
      scene_gpu.upload(scene, MeshUsage::kStreamed);
      const auto uploaded = Clock::now();
      const Contact contact =
          radar.query(instance, poses[which].direction_world, kDistance_m, {&scene_mesh, 1});
      const auto end = Clock::now();
      if (i >= poses.size()) continue;
      all_ms.push_back(ms(end - start));
      upload_ms.push_back(ms(uploaded - start));
      if (round > 0) continue;  // the answers repeat
      row.pixel_m = std::max(row.pixel_m, contact.pixel_m);
      if (contact && exact_m[which]) late_m.push_back(contact.travel_m - *exact_m[which]);
      if (contact && !exact_m[which]) ++row.false_contacts;
      if (!contact && exact_m[which]) ++row.missed;
    }
  }
  std::vector<double> error_m;
  for (const double late : late_m) {
    error_m.push_back(std::abs(late));
    row.early_max_m = std::max(row.early_max_m, -late);
  }
  row.contacts = static_cast<int>(late_m.size());
  row.median_ms = quantile(all_ms, 0.5);
  row.p95_ms = quantile(all_ms, 0.95);
  row.upload_median_ms = quantile(upload_ms, 0.5);
  row.error_median_m = quantile(error_m, 0.5);
  row.error_max_m = quantile(error_m, 1.0);
  return row;
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(": ") + 2);
  }
  return "unknown processor";
}

void write_json(const char* path, const std::vector<Row>& rows) {
  std::ofstream file(path);
  file << "[\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& r = rows[i];
    char line[512];
    std::snprintf(
        line, sizeof line,
        R"(  {"method": "sampled", "scene_triangles": %zu, "sensor_triangles": %zu, "radar_px": %d, )"
        R"("median_ms": %.4f, "p95_ms": %.4f, "upload_median_ms": %.4f, "error_median_m": %.7f, )"
        R"("error_max_m": %.7f, "early_max_m": %.7f, "pixel_m": %.6f, "contacts": %d, "false_contacts": %d, "missed": %d})",
        r.scene_triangles, r.sensor_triangles, r.radar_px, r.median_ms, r.p95_ms, r.upload_median_ms,
        r.error_median_m, r.error_max_m, r.early_max_m, r.pixel_m, r.contacts, r.false_contacts, r.missed);
    file << line << (i + 1 < rows.size() ? ",\n" : "\n");
  }
  file << "]\n";
  if (!file.flush()) throw Error(std::string(path) + ": cannot be written");
}

int run(int argc, char** argv) {
  const char* json_path = nullptr;
  int pose_count = 24;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--json") == 0) json_path = argv[i + 1];
    if (std::strcmp(argv[i], "--poses") == 0) pose_count = std::clamp(std::atoi(argv[i + 1]), 1, 10000);
  }
  GlContext context;
  std::printf("%s, %ld cores; %s; compiler %s, flags %s\n", processor().c_str(),
              sysconf(_SC_NPROCESSORS_ONLN), context.renderer().c_str(), __VERSION__, ROOMRADAR_FLAGS);
  std::printf("%d free poses, %.1f m ahead; times are upload of the scene and query together\n", pose_count,
              kDistance_m);
  std::printf("%9s %9s %5s | %9s %9s %9s | %9s %9s %9s %8s %5s %6s\n", "scene", "sensor", "px", "median ms",
              "p95 ms", "upload ms", "late med", "late max", "early max", "pixel mm", "false", "missed");
  const DepthImage depth_m = depth_frame();
  const Mesh coarse = frame_mesh(depth_m, 4);
  const std::vector<Pose> poses = free_poses(coarse, depth_m, pose_count);
  std::vector<Row> rows;
  for (const int stride : {4, 1}) {
    const Mesh scene = stride == 4 ? coarse : frame_mesh(depth_m, stride);
    for (const Mesh& sensor : {cube(0.14F), bumpy_torus(68, 46), bumpy_torus(434, 209)}) {
      std::vector<std::optional<double>> exact_m;
      for (const Pose& pose : poses) {
        exact_m.push_back(exact_travel(sensor, pose.T_world_sensor, pose.direction_world, kDistance_m, scene,
                                       Eigen::Isometry3d::Identity()));
      }
      for (const int radar_px : {64, 128, 256}) {
        const Row r = measure(context, scene, sensor, poses, exact_m, radar_px);
        std::printf("%9zu %9zu %5d | %9.3f %9.3f %9.3f | %6.3f mm %6.3f mm %6.3f mm %8.2f %5d %6d\n",
                    r.scene_triangles, r.sensor_triangles, r.radar_px, r.median_ms, r.p95_ms,
                    r.upload_median_ms, 1e3 * r.error_median_m, 1e3 * r.error_max_m, 1e3 * r.early_max_m,
                    1e3 * r.pixel_m, r.false_contacts, r.missed);
        std::fflush(stdout);
        rows.push_back(r);
      }
    }
  }
  if (json_path != nullptr) write_json(json_path, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  try {
    return roomradar::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "radar_bench: %s\n", error.what());
    return 1;
  }
}
