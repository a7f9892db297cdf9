// components.cpp: union-find over shared vertices.
#include "mapping/mesh/components.hpp"

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <vector>

namespace roomradar {
namespace {

float area_m2(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3f& a = mesh.vertices[t[0]];
  return 0.5F * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
}

}  // namespace

DisjointSets<std::uint32_t> components_of(const Mesh& mesh) {
  DisjointSets<std::uint32_t> pieces(static_cast<std::uint32_t>(mesh.vertices.size()));
  for (const Triangle& t : mesh.triangles) {
    pieces.join(t[1], t[0]);
    pieces.join(t[2], t[0]);
  }
  return pieces;
}

Mesh compacted(const Mesh& mesh, const std::vector<Triangle>& triangles) {
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  std::vector<std::uint32_t> renamed(mesh.vertices.size(), kUnused);
  Mesh out;
  out.origin = mesh.origin;
  out.triangles.reserve(triangles.size());
  for (const Triangle& old_triangle : triangles) {
    Triangle& triangle = out.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t old = old_triangle[k];
      if (renamed[old] == kUnused) {
        renamed[old] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[old]);
        if (!mesh.normals.empty()) out.normals.push_back(mesh.normals[old]);
        if (!mesh.colours.empty()) out.colours.push_back(mesh.colours[old]);
      }
      triangle[k] = renamed[old];
    }
  }
  return out;
}

Mesh drop_small_components(const Mesh& mesh, float min_component_area_m2,
                           const std::function<bool(std::uint32_t)>& is_cut) {
  DisjointSets<std::uint32_t> pieces = components_of(mesh);
  std::vector<float> piece_area_m2(mesh.vertices.size(), 0.0F);
  for (const Triangle& t : mesh.triangles) piece_area_m2[pieces.find(t[0])] += area_m2(mesh, t);
  for (std::uint32_t v = 0; is_cut && v < mesh.vertices.size(); ++v)
    if (is_cut(v)) piece_area_m2[pieces.find(v)] = std::numeric_limits<float>::infinity();
  std::vector<Triangle> kept;
  for (const Triangle& t : mesh.triangles)
    if (piece_area_m2[pieces.find(t[0])] >= min_component_area_m2) kept.push_back(t);
  return compacted(mesh, kept);
}

}  // namespace roomradar
