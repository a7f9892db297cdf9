// room_mesh.cpp: meshes inflated boxes as lattices of core corners and directions, cylinders as surfaces of
// revolution.
#include "app/sim/room/room_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace roomradar {
namespace {

using Eigen::Vector3d;

/// Adds triangles of one convex solid, each oriented away from the solid's centre.
struct ConvexBuilder {
  const Solid& solid;
  Rgb colour;
  Mesh& mesh;
  std::vector<Vector3d> local = {};
  std::size_t first = mesh.vertices.size();

  std::uint32_t vertex(const Vector3d& p_solid) {
    local.push_back(p_solid);
    mesh.vertices.push_back((solid.T_world_solid * p_solid - mesh.origin).cast<float>());
    mesh.colours.push_back(colour);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vector3d& pa = local[a - first];
    const Vector3d& pb = local[b - first];
    const Vector3d& pc = local[c - first];
    if ((pb - pa).cross(pc - pa).dot(pa + pb + pc) < 0.0) std::swap(b, c);
    mesh.triangles.push_back({a, b, c});
  }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
};

/// Returns the number of segments per quarter turn that keeps chords within deviation_m of the circle.
int quarter_parts(double radius_m, double deviation_m) {
  if (radius_m <= deviation_m) return 1;
  return std::clamp(static_cast<int>(std::ceil(0.5 / std::acos(1.0 - deviation_m / radius_m))), 1, 128);
}

void append_box(ConvexBuilder& builder, double deviation_m) {
  const Solid& solid = builder.solid;
  // Per axis: positions on the core, and components of a direction. The surface point of a lattice point on
  // the hull is core + round * direction. Flat faces span the two ends of the core, where the component is 0.
  struct Tick {
    double core, direction;
  };
  std::array<std::vector<Tick>, 3> ticks;
  const int parts = solid.round_m > 0.0 ? 2 * quarter_parts(solid.round_m, deviation_m) : 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Tick>& along = ticks[static_cast<std::size_t>(axis)];
    const double half_m = solid.half_m[axis];
    for (int i = parts; i > 0; --i)
      along.push_back({-half_m, -std::tan(0.25 * std::numbers::pi * i / parts)});
    along.push_back({-half_m, 0.0});
    if (half_m > 0.0) along.push_back({half_m, 0.0});
    for (int i = 1; i <= parts; ++i) along.push_back({half_m, std::tan(0.25 * std::numbers::pi * i / parts)});
  }
  std::map<std::array<std::size_t, 3>, std::uint32_t> known;
  const auto vertex_at = [&](const std::array<std::size_t, 3>& at) {
    const auto [entry, is_new] = known.try_emplace(at, 0);
    if (is_new) {
      Vector3d core, direction;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        core[static_cast<Eigen::Index>(axis)] = ticks[axis][at[axis]].core;
        direction[static_cast<Eigen::Index>(axis)] = ticks[axis][at[axis]].direction;
      }
      entry->second =
          builder.vertex(parts > 0 ? Vector3d(core + solid.round_m * direction.normalized()) : core);
    }
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
    for (const std::size_t side : {std::size_t{0}, ticks[axis].size() - 1})
      for (std::size_t i = 0; i + 1 < ticks[next].size(); ++i)
        for (std::size_t j = 0; j + 1 < ticks[last].size(); ++j) {
          const auto corner = [&](std::size_t di, std::size_t dj) {
            std::array<std::size_t, 3> at{};
            at[axis] = side;
            at[next] = i + di;
            at[last] = j + dj;
            return vertex_at(at);
          };
          builder.quad(corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
        }
  }
}

void append_cylinder(ConvexBuilder& builder, double deviation_m) {
  const Solid& solid = builder.solid;
  const double widest_m = solid.half_m.x() + solid.round_m;
  const int around = 8 * quarter_parts(widest_m, deviation_m);
  const int parts = solid.round_m > 0.0 ? 2 * quarter_parts(solid.round_m, deviation_m) : 0;
  struct Ring {
    double radius_m, z_m;
  };
  std::vector<Ring> rings;
  for (const double side : {-1.0, 1.0})
    for (int i = 0; i <= parts; ++i) {
      const double part = parts == 0 ? 0.0 : static_cast<double>(side < 0 ? parts - i : i) / parts;
      const double angle = 0.5 * std::numbers::pi * part;
      const double radius_m = solid.half_m.x() + solid.round_m * std::cos(angle);
      if (radius_m < 1e-12) continue;  // the cap's centre is added below
      rings.push_back({radius_m, side * (solid.half_m.z() + solid.round_m * std::sin(angle))});
    }
  std::vector<std::uint32_t> below, ring;
  const double end_m = solid.half_m.z() + solid.round_m;
  const std::uint32_t bottom = builder.vertex({0, 0, -end_m}), top = builder.vertex({0, 0, end_m});
  for (const Ring& now : rings) {
    ring.clear();
    for (int i = 0; i < around; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / around;
      ring.push_back(
          builder.vertex({now.radius_m * std::cos(angle), now.radius_m * std::sin(angle), now.z_m}));
    }
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::size_t j = (i + 1) % ring.size();
      if (below.empty()) {
        builder.triangle(bottom, ring[i], ring[j]);
      } else {
        builder.quad(below[i], below[j], ring[j], ring[i]);
      }
    }
    below = ring;
  }
  for (std::size_t i = 0; i < below.size(); ++i)
    builder.triangle(top, below[i], below[(i + 1) % below.size()]);
}

}  // namespace

void append_mesh(const Solid& solid, Rgb colour, double deviation_m, Mesh& mesh) {
  ConvexBuilder builder{solid, colour, mesh};
  if (solid.shape == SolidShape::kBox) {
    append_box(builder, deviation_m);
  } else {
    append_cylinder(builder, deviation_m);
  }
}

Mesh room_mesh(const Room& room, double deviation_m) {
  Mesh mesh;
  for (std::size_t i = 0; i < room.solids.size(); ++i)
    append_mesh(room.solids[i], room.materials[i].first, deviation_m, mesh);
  return mesh;
}

}  // namespace roomradar
