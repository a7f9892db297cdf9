// object_lod.cpp: simplifies a mesh step by step, each level from a finer one.
#include "app/objects/object_lod.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "app/objects/fit_normals.hpp"
#include "mapping/mesh/mesh_simplify.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kFewTriangles = 100;
constexpr std::size_t kManyTriangles = 1000;  // smaller meshes render within a tenth of a millisecond
constexpr float kFinestOfSize = 1.0F / 1024.0F;
constexpr float kCoarsestOfSize = 1.0F / 8.0F;
constexpr float kCoarser = 1.41421356F;  // ratio of the max deviations of successive levels
constexpr float kBaseOfBound =
    0.25F;  // max deviation of a level's base mesh, over its bound; the finest is exempt
// Smaller meshes are simplified as one block, without seams whose vertices must stay.
constexpr std::size_t kWholeTriangles = 30'000;
constexpr float kSpacingOfSize = 0.02F;  // between sample points that measure deviations
constexpr float kWorthHaving = 0.75F;    // max triangle count relative to the previous level

Eigen::Vector3f area_normal(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return (b - a).cross(c - a);
}

/// Returns true if all indices are in range and all vertices are finite.
bool is_sound(const Mesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Eigen::Vector3f& p) { return p.allFinite(); }) &&
         std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const Triangle& t) { return is_usable(mesh, t); });
}

/// Merges coincident vertices: some files have three per triangle, so no triangles are connected.
void weld(Mesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> known;
  std::vector<std::uint32_t> name(mesh.vertices.size());
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Rgb> colours;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3f& p = mesh.vertices[v];
    const auto [at, is_new] =
        known.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(vertices.size()));
    name[v] = at->second;
    if (!is_new) continue;
    vertices.push_back(p);
    if (!mesh.colours.empty()) colours.push_back(mesh.colours[v]);
  }
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& vertex : t) vertex = name[vertex];
  std::erase_if(mesh.triangles,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  mesh.vertices = std::move(vertices);
  mesh.colours = std::move(colours);
}

/// @param by_position  vertices at the same position get the same normal
void set_mean_normals(Mesh& mesh, bool by_position) {
  mesh.normals.assign(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t vertex : t) mesh.normals[vertex] += area_normal(mesh, t);
  if (by_position) {
    std::map<std::array<float, 3>, Eigen::Vector3f> sums;
    const auto sum_at = [&](std::size_t v) -> Eigen::Vector3f& {
      const Eigen::Vector3f& p = mesh.vertices[v];
      return sums.try_emplace({p.x(), p.y(), p.z()}, Eigen::Vector3f::Zero()).first->second;
    };
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) sum_at(v) += mesh.normals[v];
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) mesh.normals[v] = sum_at(v);
  }
  for (Eigen::Vector3f& normal : mesh.normals) {
    const float length = normal.norm();
    normal = length > 0.0F ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::UnitZ();
  }
}

/// Gives corners at sharp edges a vertex of their own with the face's normal.
void sharpen(LevelOfDetail& level) {
  Mesh& mesh = level.mesh;
  constexpr float kCosSmooth = 0.906F;  // 25 degrees
  for (Triangle& t : mesh.triangles) {
    const Eigen::Vector3f along = area_normal(mesh, t);
    const float length = along.norm();
    if (!(length > 0.0F)) continue;
    const Eigen::Vector3f face = along / length;
    for (std::uint32_t& vertex : t) {
      if (mesh.normals[vertex].dot(face) >= kCosSmooth) continue;
      mesh.vertices.push_back(Eigen::Vector3f(mesh.vertices[vertex]));
      mesh.normals.push_back(face);
      if (!mesh.colours.empty()) mesh.colours.push_back(Rgb(mesh.colours[vertex]));
      if (!level.full_vertex.empty()) level.full_vertex.push_back(std::uint32_t{level.full_vertex[vertex]});
      vertex = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    }
  }
}

bool is_large(const Mesh& mesh) { return mesh.triangles.size() > kWholeTriangles; }

/// Returns the mesh to simplify a level from: the coarsest one that leaves most of the bound; a large mesh is
/// used only once.
const LevelOfDetail& base_of(float bound_m, const LevelOfDetail& full,
                             std::span<const LevelOfDetail> levels) {
  const LevelOfDetail* base = is_large(full.mesh) && !levels.empty() ? levels.data() : &full;
  for (const LevelOfDetail& level : levels)
    if (level.deviation_m <= kBaseOfBound * bound_m) base = &level;
  return *base;
}

}  // namespace

std::vector<LevelOfDetail> levels_of_detail(const Mesh& mesh, bool keeps_seams) {
  std::vector<LevelOfDetail> levels;
  if (mesh.triangles.size() < kManyTriangles || !is_sound(mesh)) return levels;
  Eigen::AlignedBox3f box;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t vertex : t) box.extend(mesh.vertices[vertex]);
  const float size_m = box.diagonal().norm();
  if (!(size_m > 0.0F) || !std::isfinite(size_m)) return levels;

  const bool has_normals = !mesh.normals.empty();
  LevelOfDetail full{mesh, 0.0F};
  if (!has_normals) {
    if (!keeps_seams) weld(full.mesh);
    set_mean_normals(full.mesh, keeps_seams);
  }
  std::size_t triangles = full.mesh.triangles.size();
  for (float bound_m = kFinestOfSize * size_m;
       bound_m <= kCoarsestOfSize * size_m && triangles > kFewTriangles; bound_m *= kCoarser) {
    // The deviation allowed here, plus the base mesh's own, stays within the bound.
    const LevelOfDetail& finer = base_of(bound_m, full, levels);
    SimplifiedMesh simple =
        simplified(finer.mesh, bound_m - finer.deviation_m, kSpacingOfSize * size_m,
                   is_large(full.mesh) && levels.empty() ? kBlockTriangles : kWholeTriangles);
    if (static_cast<float>(simple.mesh.triangles.size()) > kWorthHaving * static_cast<float>(triangles))
      continue;
    triangles = simple.mesh.triangles.size();
    const float off_m = finer.deviation_m + simple.deviation_m;
    LevelOfDetail level{std::move(simple.mesh), off_m};
    if (keeps_seams)
      for (const std::uint32_t vertex : simple.full_vertex)
        level.full_vertex.push_back(finer.full_vertex.empty() ? vertex : finer.full_vertex[vertex]);
    // fewer triangles and no larger deviation; `finer` may be one of the levels removed
    while (!levels.empty() && levels.back().deviation_m >= off_m) levels.pop_back();
    levels.push_back(std::move(level));
  }

  if (!has_normals) sharpen(full);
  for (auto level = levels.begin(); level != levels.end(); ++level) {
    if (!has_normals) sharpen(*level);
    const LevelOfDetail& finer = base_of(level->deviation_m, full, {levels.begin(), level});
    fit_normals(finer.mesh, level->deviation_m + finer.deviation_m, kSpacingOfSize * size_m, level->mesh);
  }
  return levels;
}

}  // namespace roomradar
