// radar_bench_shapes.cpp: fixed shapes from fixed seeds; changing any breaks the comparison with earlier
// results.
#include "radar_bench_shapes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace roomradar::bench {
namespace {

constexpr Intrinsics kCamera{640, 480, 585.0, 585.0, 319.5, 239.5};
constexpr double kTurn = 2.0 * std::numbers::pi;

DepthImage table_depth() {
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
  const double tilt = 0.6;  // angle by which the camera looks down on the table, rad
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

void append(Mesh& mesh, const Mesh& part, const Eigen::Isometry3f& T_mesh_part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : part.vertices) mesh.vertices.push_back(T_mesh_part * vertex);
  for (const Triangle& t : part.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

/// Revolves a profile of (radius, height) about z; its first and last point are on the axis. A profile that
/// runs counter-clockwise in the r-z half-plane (from the lower axis point outwards and up) gives outward
/// triangles.
Mesh turned(const std::vector<Eigen::Vector2f>& profile_m, int around) {
  Mesh mesh;
  const auto count = static_cast<int>(profile_m.size());
  for (int i = 0; i < around; ++i) {
    const auto a = static_cast<float>(kTurn * i / around);
    for (const Eigen::Vector2f& p : profile_m) {
      mesh.vertices.emplace_back(p.x() * std::cos(a), p.x() * std::sin(a), p.y());
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % around) * count + j); };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j + 1 < count; ++j) {
      if (j > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (j + 2 < count || j == 0) mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

}  // namespace

FrameScene table_frame(int stride_px) {
  FrameScene frame{.camera = kCamera, .depth_m = table_depth(), .stride_px = stride_px, .mesh = {}};
  Mesh& mesh = frame.mesh;
  const int columns = (kCamera.width_px - 1) / stride_px + 1, rows = (kCamera.height_px - 1) / stride_px + 1;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int u = i * stride_px, v = j * stride_px;
      mesh.vertices.push_back(back_project(kCamera, u, v, frame.depth_m.at(u, v)).cast<float>());
    }
  }
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const auto a = static_cast<std::uint32_t>(j * columns + i);
      const auto c = a + static_cast<std::uint32_t>(columns);
      mesh.triangles.push_back({a, c, c + 1});  // counter-clockwise seen from the camera (y down)
      mesh.triangles.push_back({a, c + 1, a + 1});
    }
  }
  return frame;
}

Mesh cup_mesh() {
  return turned({{0.0F, -0.05F},
                 {0.03F, -0.05F},
                 {0.04F, 0.0F},
                 {0.04F, 0.05F},
                 {0.035F, 0.05F},
                 {0.035F, 0.0F},
                 {0.025F, -0.045F},
                 {0.0F, -0.045F}},
                40);
}

Mesh chair_mesh() {
  Mesh mesh;
  const auto add = [&](const Eigen::Vector3f& size_m, const Eigen::Vector3f& centre_m) {
    append(mesh, box_mesh(size_m), Eigen::Isometry3f(Eigen::Translation3f(centre_m)));
  };
  add({0.45F, 0.45F, 0.03F}, {0.0F, 0.0F, 0.0F});
  add({0.45F, 0.03F, 0.45F}, {0.0F, -0.21F, 0.24F});
  for (const float x : {-0.205F, 0.205F}) {
    for (const float y : {-0.205F, 0.205F}) add({0.04F, 0.04F, 0.43F}, {x, y, -0.23F});
  }
  return mesh;
}

Mesh sticks_mesh(int count, unsigned seed, std::vector<Eigen::Vector3d>& tips_m) {
  Mesh mesh;
  tips_m.clear();
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  std::normal_distribution<float> normal;
  for (int i = 0; i < count; ++i) {
    const float r_m = 0.01F + 0.005F * uniform(random), h_m = 0.2F;
    const float w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    const float cx = uniform(random), cy = uniform(random), cz = uniform(random);
    const Eigen::Isometry3f T_world_stick =
        Eigen::Translation3f(cx, cy, cz) * Eigen::Quaternionf(w, x, y, z).normalized();
    append(mesh, turned({{0.0F, -h_m}, {r_m, -h_m}, {r_m, h_m}, {0.0F, h_m}}, 7), T_world_stick);
    tips_m.push_back((T_world_stick * Eigen::Vector3f(0.0F, 0.0F, h_m)).cast<double>());
  }
  return mesh;
}

std::vector<Sensor> sensors() {
  return {{"cube", box_mesh({0.15F, 0.15F, 0.15F})},
          {"torus", bumpy_torus(68, 46)},
          {"fine torus", bumpy_torus(434, 209)}};
}

Sensor torus_sized_box() { return {"box", published_objects().front()}; }

std::vector<Sensor> concave_sensors() {
  return {{"torus", bumpy_torus(68, 46)}, {"cup", cup_mesh()}, {"chair", chair_mesh()}};
}

}  // namespace roomradar::bench
