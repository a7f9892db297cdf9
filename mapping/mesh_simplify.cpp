// mesh_simplify.cpp: edge collapse by meshoptimizer, and specks out.
#include "mapping/mesh_simplify.hpp"

#include <meshoptimizer.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace roomradar {
namespace {

constexpr float kThinnest_m = 1e-5F;

// A mesh of these triangles (indices into `mesh`), with only the vertices that they use, in the order of
// their use.
Mesh compacted(const Mesh& mesh, const std::vector<std::uint32_t>& corners) {
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  std::vector<std::uint32_t> renamed(mesh.vertices.size(), kUnused);
  Mesh out;
  out.origin = mesh.origin;
  out.triangles.reserve(corners.size() / 3);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    Triangle& triangle = out.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t old = corners[i + k];
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

// Shortest height of a triangle; 0 for two corners in one place.
float height_m(const Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Eigen::Vector3f u = mesh.vertices[b] - mesh.vertices[a];
  const Eigen::Vector3f v = mesh.vertices[c] - mesh.vertices[a];
  const float longest = std::sqrt(std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()}));
  return longest > 0.0F ? u.cross(v).norm() / longest : 0.0F;
}

float area_m2(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3f& a = mesh.vertices[t[0]];
  return 0.5F * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
}

std::vector<std::uint32_t> corners_of(const Mesh& mesh) {
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  return corners;
}

}  // namespace

Mesh simplified(const Mesh& mesh, float max_deviation_m) {
  if (mesh.triangles.empty()) return mesh;
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  const float* positions = mesh.vertices.front().data();
  const float scale_m = meshopt_simplifyScale(positions, mesh.vertices.size(), sizeof(Eigen::Vector3f));
  if (!(scale_m > 0.0F)) return mesh;
  std::vector<std::uint32_t> corners = corners_of(mesh);
  const std::size_t kept =
      meshopt_simplify(corners.data(), corners.data(), corners.size(), positions, mesh.vertices.size(),
                       sizeof(Eigen::Vector3f), /*target_index_count=*/0, max_deviation_m / scale_m,
                       /*options=*/0, /*result_error=*/nullptr);
  corners.resize(kept);
  // What is thinner than a file's floats can tell goes, so that a mesh reads back as it was written.
  std::size_t used = 0;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    if (height_m(mesh, corners[i], corners[i + 1], corners[i + 2]) < kThinnest_m) continue;
    std::copy_n(corners.begin() + static_cast<std::ptrdiff_t>(i), 3,
                corners.begin() + static_cast<std::ptrdiff_t>(used));
    used += 3;
  }
  corners.resize(used);
  return compacted(mesh, corners);
}

Mesh without_specks(const Mesh& mesh, float min_component_area_m2) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto piece = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    parent[piece(t[1])] = piece(t[0]);
    parent[piece(t[2])] = piece(t[0]);
  }
  std::vector<float> piece_area_m2(mesh.vertices.size(), 0.0F);
  for (const Triangle& t : mesh.triangles) piece_area_m2[piece(t[0])] += area_m2(mesh, t);
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : mesh.triangles)
    if (piece_area_m2[piece(t[0])] >= min_component_area_m2)
      corners.insert(corners.end(), t.begin(), t.end());
  return compacted(mesh, corners);
}

}  // namespace roomradar
