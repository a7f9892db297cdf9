// components.cpp: union-find over shared vertices.
#include "mapping/mesh/components.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace roomradar {
namespace {

float area_m2(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3f& a = mesh.vertices[t[0]];
  return 0.5F * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
}

/// Replaces the values by those at these indices. No values remain none.
template <typename T>
void pick(std::vector<T>& values, const std::vector<std::uint32_t>& indices) {
  if (values.empty()) return;
  std::vector<T> picked(indices.size());
  std::transform(indices.begin(), indices.end(), picked.begin(), [&](std::uint32_t i) { return values[i]; });
  values = std::move(picked);
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

std::vector<std::uint32_t> drop_unused_vertices(Mesh& mesh) {
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  std::vector<std::uint32_t> renamed(mesh.vertices.size(), kUnused);
  std::vector<std::uint32_t> used;
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& v : triangle) {
      if (renamed[v] == kUnused) {
        renamed[v] = static_cast<std::uint32_t>(used.size());
        used.push_back(v);
      }
      v = renamed[v];
    }
  pick(mesh.vertices, used);
  pick(mesh.normals, used);
  pick(mesh.colours, used);
  return used;
}

Mesh drop_small_components(Mesh mesh, float min_component_area_m2,
                           const std::function<bool(const Eigen::Vector3d&)>& is_cut) {
  DisjointSets<std::uint32_t> pieces = components_of(mesh);
  std::vector<float> piece_area_m2(mesh.vertices.size(), 0.0F);
  for (const Triangle& t : mesh.triangles) piece_area_m2[pieces.find(t[0])] += area_m2(mesh, t);
  for (std::uint32_t v = 0; is_cut && v < mesh.vertices.size(); ++v)
    if (is_cut(mesh.origin + mesh.vertices[v].cast<double>()))
      piece_area_m2[pieces.find(v)] = std::numeric_limits<float>::infinity();
  std::erase_if(mesh.triangles,
                [&](const Triangle& t) { return piece_area_m2[pieces.find(t[0])] < min_component_area_m2; });
  drop_unused_vertices(mesh);
  return mesh;
}

}  // namespace roomradar
