// object_levels.cpp: simplify step by step, each level from the one before.
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
constexpr std::size_t kManyTriangles = 1000;  // fewer are drawn as they are, within a tenth of a millisecond
constexpr float kFinestOfSize = 1.0F / 1024.0F;
constexpr float kCoarsestOfSize = 1.0F / 8.0F;
constexpr float kCoarser = 1.41421356F;  // how much farther off each level may lie than the one before
constexpr float kBaseOfBound = 0.25F;    // so far off may lie what a level is made from, or it is the finest
constexpr std::size_t kWholeTriangles =
    30'000;                              // what is left is done in one, with no vertices kept on seams
constexpr float kSpacingOfSize = 0.02F;  // of the points at which deviations are measured
constexpr float kWorthHaving = 0.75F;    // of the triangles of the level before

Eigen::Vector3f area_normal(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return (b - a).cross(c - a);
}

/// Every index names a vertex, and every vertex is somewhere.
bool is_sound(const Mesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Eigen::Vector3f& p) { return p.allFinite(); }) &&
         std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const Triangle& t) { return is_usable(mesh, t); });
}

/// Vertices at one place become one: some files have three for each triangle, and nothing hangs together.
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

void set_mean_normals(Mesh& mesh) {
  mesh.normals.assign(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t vertex : t) mesh.normals[vertex] += area_normal(mesh, t);
  for (Eigen::Vector3f& normal : mesh.normals) {
    const float length = normal.norm();
    normal = length > 0.0F ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::UnitZ();
  }
}

/// Gives corners at the thing's edges a vertex of their own with the face's normal.
void sharpen(Mesh& mesh) {
  constexpr float kCosSmooth = 0.906F;  // of 25 degrees
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
      vertex = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    }
  }
}

bool is_large(const Mesh& mesh) { return mesh.triangles.size() > kWholeTriangles; }

/// What a level is made from: the coarsest that leaves most of the bound, but no large mesh twice.
const ObjectLevel& base_of(float bound_m, const ObjectLevel& full, std::span<const ObjectLevel> levels) {
  const ObjectLevel* base = is_large(full.mesh) && !levels.empty() ? levels.data() : &full;
  for (const ObjectLevel& level : levels)
    if (level.deviation_m <= kBaseOfBound * bound_m) base = &level;
  return *base;
}

}  // namespace

std::vector<ObjectLevel> object_levels(const Mesh& mesh) {
  std::vector<ObjectLevel> levels;
  if (mesh.triangles.size() < kManyTriangles || !is_sound(mesh)) return levels;
  Eigen::AlignedBox3f box;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t vertex : t) box.extend(mesh.vertices[vertex]);
  const float size_m = box.diagonal().norm();
  if (!(size_m > 0.0F) || !std::isfinite(size_m)) return levels;

  const bool has_normals = !mesh.normals.empty();
  ObjectLevel full{mesh, 0.0F};
  if (!has_normals) {
    weld(full.mesh);
    set_mean_normals(full.mesh);
  }
  std::size_t triangles = full.mesh.triangles.size();
  for (float bound_m = kFinestOfSize * size_m;
       bound_m <= kCoarsestOfSize * size_m && triangles > kFewTriangles; bound_m *= kCoarser) {
    // This one may lie so far off the one it is made from that both together stay within the bound.
    const ObjectLevel& finer = base_of(bound_m, full, levels);
    SimplifiedMesh simple =
        simplified(finer.mesh, bound_m - finer.deviation_m, kSpacingOfSize * size_m,
                   is_large(full.mesh) && levels.empty() ? kBlockTriangles : kWholeTriangles);
    if (static_cast<float>(simple.mesh.triangles.size()) > kWorthHaving * static_cast<float>(triangles))
      continue;
    triangles = simple.mesh.triangles.size();
    const float off_m = finer.deviation_m + simple.deviation_m;
    while (!levels.empty() && levels.back().deviation_m >= off_m) levels.pop_back();  // fewer lie nearer
    levels.push_back({std::move(simple.mesh), off_m});
  }

  if (!has_normals) sharpen(full.mesh);
  for (auto level = levels.begin(); level != levels.end(); ++level) {
    if (!has_normals) sharpen(level->mesh);
    const ObjectLevel& finer = base_of(level->deviation_m, full, {levels.begin(), level});
    fit_normals(finer.mesh, level->deviation_m + finer.deviation_m, kSpacingOfSize * size_m, level->mesh);
  }
  return levels;
}

}  // namespace roomradar
