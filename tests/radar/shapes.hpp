// shapes.hpp: small meshes with known geometry for the radar's tests.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <vector>

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

/// The same box, each side made of cells x cells quads.
inline Mesh box_of_cells(const Eigen::Vector3f& size_m, int cells) {
  Mesh mesh;
  const Eigen::Vector3f h = 0.5F * size_m;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const auto at = [&](int i, int j) {
        const auto part = [&](int k) {
          return static_cast<float>(2 * k - cells) / static_cast<float>(cells);
        };
        Eigen::Vector3f p;
        p[axis] = static_cast<float>(side) * h[axis];
        p[(axis + 1) % 3] = part(i) * h[(axis + 1) % 3];
        p[(axis + 2) % 3] = static_cast<float>(side) * part(j) * h[(axis + 2) % 3];
        return p;
      };
      for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
          add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
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

/// Merges the parts, each translated by its vector. All parts must have the same origin.
inline Mesh together(std::span<const std::pair<Mesh, Eigen::Vector3f>> parts) {
  Mesh mesh;
  for (const auto& [part, at_m] : parts) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3f& p : part.vertices) mesh.vertices.push_back(p + at_m);
    for (const Triangle& t : part.triangles) {
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  return mesh;
}

/// Revolves an outline of points (radius, height) about the z axis. The result is closed if the outline
/// begins and ends at radius 0 or returns to its first point. It faces outwards if the outline runs upwards
/// on the outside.
inline Mesh turned(const std::vector<Eigen::Vector2f>& outline, int around) {
  Mesh mesh;
  constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
  const auto steps = static_cast<std::uint32_t>(around);
  const auto rows = static_cast<std::uint32_t>(outline.size());
  for (const Eigen::Vector2f& p : outline) {
    for (int i = 0; i < around; ++i) {
      const float a = kTurn * static_cast<float>(i) / static_cast<float>(around);
      mesh.vertices.emplace_back(p.x() * std::cos(a), p.x() * std::sin(a), p.y());
    }
  }
  for (std::uint32_t row = 0; row + 1 < rows; ++row) {
    for (std::uint32_t i = 0; i < steps; ++i) {
      const std::uint32_t a = row * steps + i, b = row * steps + (i + 1) % steps;
      const std::uint32_t c = a + steps, d = b + steps;
      if (outline[row].x() > 0.0F) mesh.triangles.push_back({a, b, d});
      if (outline[row + 1].x() > 0.0F) mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

inline Mesh ball(float radius_m, int rows, int around) {
  std::vector<Eigen::Vector2f> outline = {{0.0F, -radius_m}};
  for (int i = 1; i < rows; ++i) {
    const float a = std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(rows);
    outline.emplace_back(radius_m * std::sin(a), -radius_m * std::cos(a));
  }
  outline.emplace_back(0.0F, radius_m);
  return turned(outline, around);
}

/// Closed surface of a cup open to +z, with walls and bottom of the given thickness; its foot is at z = 0.
inline Mesh cup(float radius_m, float height_m, float thickness_m, int around) {
  const float inner_m = radius_m - thickness_m;
  return turned({{0.0F, 0.0F},
                 {radius_m, 0.0F},
                 {radius_m, height_m},
                 {inner_m, height_m},
                 {inner_m, thickness_m},
                 {0.0F, thickness_m}},
                around);
}

/// Seat, back and four legs, each a closed box that overlaps its neighbours; the legs stand on z = 0.
inline Mesh chair() {
  std::vector<std::pair<Mesh, Eigen::Vector3f>> parts = {{box({0.40F, 0.40F, 0.04F}), {0.0F, 0.0F, 0.43F}},
                                                         {box({0.40F, 0.04F, 0.42F}), {0.0F, 0.18F, 0.65F}}};
  for (const float x : {-0.17F, 0.17F}) {
    for (const float y : {-0.17F, 0.17F}) parts.push_back({box({0.04F, 0.04F, 0.42F}), {x, y, 0.21F}});
  }
  return together(parts);
}

/// Ground with bumps of two scales, as on a cluttered table, 2 m wide, facing +z; heights within 0.065 m of
/// 0.
inline Mesh bumpy_ground(int cells) {
  Mesh mesh;
  const auto height_m = [](double x, double y) {
    return 0.05 * std::sin(7.0 * x) * std::cos(6.0 * y) +
           0.015 * std::sin(41.0 * x + 3.0) * std::sin(37.0 * y);
  };
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = 2.0 * i / cells - 1.0, y = 2.0 * j / cells - 1.0;
      mesh.vertices.push_back(Eigen::Vector3d(x, y, height_m(x, y)).cast<float>());
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (cells + 1) + i); };
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

constexpr double kThorn_m = 0.03125;

/// Flat ground at height 0, 2 m wide, 2 * cells^2 triangles; its middle vertex is raised to form a thorn.
inline Mesh thorny_grid(int cells) {
  Mesh mesh;
  const float cell_m = 2.0F / static_cast<float>(cells);
  const auto row = static_cast<std::size_t>(cells) + 1;
  mesh.vertices.reserve(row * row);
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      mesh.vertices.emplace_back(static_cast<float>(i) * cell_m - 1.0F, static_cast<float>(j) * cell_m - 1.0F,
                                 0.0F);
    }
  }
  mesh.vertices[row * static_cast<std::size_t>(cells / 2) + static_cast<std::size_t>(cells / 2)].z() =
      static_cast<float>(kThorn_m);
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (cells + 1) + i); };
  mesh.triangles.reserve(2 * static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells));
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
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

/// The same surface plus duplicate, degenerate and invalid triangles: vertex indices out of range, vertices
/// not finite.
inline Mesh spoilt(Mesh mesh) {
  const std::size_t count = mesh.triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle t = mesh.triangles[i];
    mesh.triangles.push_back(t);                          // duplicate
    mesh.triangles.push_back({t[0], t[0], t[1]});         // a line
    mesh.triangles.push_back({t[2], t[2], t[2]});         // a point
    mesh.triangles.push_back({t[0], t[1], 4000000000U});  // vertex out of range
  }
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  mesh.vertices.insert(mesh.vertices.end(), {{nan, 0, 0}, {0, 0, -inf}, {nan, nan, nan}});
  mesh.triangles.push_back({first, 0, 1});
  mesh.triangles.push_back({0, first + 1, 2});
  mesh.triangles.push_back({first + 2, first + 2, 2});
  return mesh;
}

}  // namespace roomradar::shapes
