// shapes.hpp: small meshes with known geometry for the radar's tests.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "mapping/types/mesh.hpp"

namespace roomradar::shapes {

/// Adds the quad a b c d (counter-clockwise seen from outside) as two triangles.
inline void add_quad(Mesh& mesh, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                     const Eigen::Vector3f& d) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Axis-aligned box about the origin, outward.
inline Mesh box(const Eigen::Vector3f& size_m) {
  Mesh mesh;
  const Eigen::Vector3f h = 0.5F * size_m;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      Eigen::Vector3f n = Eigen::Vector3f::Zero();
      Eigen::Vector3f s = Eigen::Vector3f::Zero();
      Eigen::Vector3f t = Eigen::Vector3f::Zero();
      n[axis] = side * h[axis];
      s[(axis + 1) % 3] = h[(axis + 1) % 3];
      t[(axis + 2) % 3] = side * h[(axis + 2) % 3];  // s x t points along n
      add_quad(mesh, n - s - t, n + s - t, n + s + t, n - s + t);
    }
  }
  return mesh;
}

/// Horizontal square at height z_m, facing +z.
inline Mesh floor(float half_size_m, float z_m) {
  Mesh mesh;
  const float h = half_size_m;
  add_quad(mesh, {-h, -h, z_m}, {h, -h, z_m}, {h, h, z_m}, {-h, h, z_m});
  return mesh;
}

/// Torus about the z axis with bumps on it (bump_m = 0: none), outward. 2 * around * across triangles.
inline Mesh torus(int around, int across, float ring_m, float tube_m, float bump_m) {
  Mesh mesh;
  constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const float a = kTurn * static_cast<float>(i) / static_cast<float>(around);
      const float b = kTurn * static_cast<float>(j) / static_cast<float>(across);
      const float tube = tube_m + bump_m * std::sin(7.0F * a) * std::sin(5.0F * b);
      const float r = ring_m + tube * std::cos(b);
      mesh.vertices.emplace_back(r * std::cos(a), r * std::sin(a), tube * std::sin(b));
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

/// Uniform in (-1, 1)^3.
inline Eigen::Vector3d random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

/// Uniform rotation.
inline Eigen::Quaterniond random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized();
}

}  // namespace roomradar::shapes
