// object_lod.cpp: simplifies the mesh, fits normals, transfers texture coordinates.
#include "app/objects/object_lod.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "mapping/mesh/mesh_distance.hpp"
#include "mapping/mesh/mesh_simplify.hpp"
#include "mapping/mesh/triangle_distance.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

/// Returns the barycentric coordinates of the point of triangle a, b, c that is nearest to p. They are
/// approximate if p projects outside the triangle.
Eigen::Vector3f triangle_weights(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                                 const Eigen::Vector3f& p) {
  const Eigen::Vector3f normal = (b - a).cross(c - a);
  const auto part = [&](const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
    return std::max(0.0F, (to - from).cross(p - from).dot(normal));
  };
  const Eigen::Vector3f weights(part(b, c), part(c, a), part(a, b));
  const float sum = weights.sum();
  return sum > 0.0F ? Eigen::Vector3f(weights / sum) : Eigen::Vector3f::Constant(1.0F / 3.0F);
}

constexpr double kAsItWas = 0.002;  // weight of a vertex's original normal, relative to its share of the area
constexpr int kMostParts = 64;      // per side of a triangle

struct Corners {
  Eigen::Vector3f a, b, c;

  [[nodiscard]] Eigen::Vector3f at(const Eigen::Vector3f& weights) const {
    return weights.x() * a + weights.y() * b + weights.z() * c;
  }
};

Corners corners_of(const std::vector<Eigen::Vector3f>& values, const Triangle& t) {
  return {values[t[0]], values[t[1]], values[t[2]]};
}

Eigen::Vector3f weights_at(const Corners& triangle, const Eigen::Vector3f& p) {
  return triangle_weights(triangle.a, triangle.b, triangle.c, p);
}

/// Calls visit(barycentric weights, area) for sample points that represent equal parts of the triangle.
template <typename Visit>
void for_each_part(const Corners& triangle, float spacing_m, const Visit& visit) {
  const Eigen::Vector3f ab = triangle.b - triangle.a, ac = triangle.c - triangle.a;
  const float area_m2 = 0.5F * ab.cross(ac).norm();
  if (!(area_m2 > 0.0F)) return;
  const float longest_m = std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()}));
  const int parts = std::clamp(static_cast<int>(std::ceil(longest_m / spacing_m)), 1, kMostParts);
  const float step = 1.0F / static_cast<float>(parts);
  const auto visit_at = [&](float u, float v) {
    visit(Eigen::Vector3f(1.0F - (u + v) * step, u * step, v * step), area_m2 * step * step);
  };
  for (int i = 0; i < parts; ++i)
    for (int j = 0; i + j < parts; ++j) {
      const float u = static_cast<float>(i), v = static_cast<float>(j);
      visit_at(u + 1.0F / 3.0F, v + 1.0F / 3.0F);
      if (i + j + 1 < parts) visit_at(u + 2.0F / 3.0F, v + 2.0F / 3.0F);
    }
}

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

/// Point of a mesh's surface.
struct SurfaceFoot {
  std::uint32_t triangle = 0;
  Eigen::Vector3f weights = Eigen::Vector3f::Zero();  ///< barycentric coordinates in the triangle
};

/// Finds nearest points by walking between triangles that share a vertex. The search does not cross seams
/// (edges with duplicated vertices), and does not reach the far side of a thin sheet. The search may end in a
/// local minimum of the distance.
class SurfaceWalk {
 public:
  /// @param mesh  must outlive the walk; all triangles valid
  explicit SurfaceWalk(const Mesh& mesh);

  /// Returns a triangle that uses `vertex`. At least one triangle must use it.
  [[nodiscard]] std::uint32_t triangle_at(std::uint32_t vertex) const { return triangles_[first_[vertex]]; }
  /// Walks from triangle `start` to the point nearest to p.
  [[nodiscard]] SurfaceFoot nearest(std::uint32_t start, const Eigen::Vector3f& p) const;

 private:
  const Mesh& mesh_;
  std::vector<std::uint32_t>
      first_;  // per vertex: index of its first entry in triangles_; then triangles_.size()
  std::vector<std::uint32_t> triangles_;  // triangles of each vertex, vertex by vertex

  [[nodiscard]] float squared_distance(std::uint32_t triangle, const Eigen::Vector3f& p) const;
};

SurfaceWalk::SurfaceWalk(const Mesh& mesh) : mesh_(mesh), first_(mesh.vertices.size() + 1, 0) {
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t vertex : t) ++first_[vertex + 1];
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  triangles_.resize(3 * mesh.triangles.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t vertex : mesh.triangles[t]) triangles_[next[vertex]++] = t;
}

float SurfaceWalk::squared_distance(std::uint32_t triangle, const Eigen::Vector3f& p) const {
  const Triangle& t = mesh_.triangles[triangle];
  return squared_distance_to_triangle(p, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
}

SurfaceFoot SurfaceWalk::nearest(std::uint32_t start, const Eigen::Vector3f& p) const {
  std::uint32_t at = start;
  float least = squared_distance(at, p);
  for (bool has_moved = true; has_moved;) {
    has_moved = false;
    const Triangle from = mesh_.triangles[at];
    for (const std::uint32_t vertex : from)
      for (std::uint32_t i = first_[vertex]; i < first_[vertex + 1]; ++i) {
        const float distance = squared_distance(triangles_[i], p);
        if (!(distance < least)) continue;
        least = distance;
        at = triangles_[i];
        has_moved = true;
      }
  }
  const Triangle& t = mesh_.triangles[at];
  return {at, triangle_weights(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]], p)};
}

constexpr double kCountedArea = 0.95;  // part of the area whose shift is bounded

/// Length along the surface by which the texture is shifted, and the area to which this applies.
struct Shift {
  float length_m = 0.0F;
  float area_m2 = 0.0F;
};

/// Returns the length that bounds the shift of kCountedArea of the area.
float bound_of(std::vector<Shift>& shifts) {
  std::sort(shifts.begin(), shifts.end(),
            [](const Shift& a, const Shift& b) { return a.length_m < b.length_m; });
  double left_m2 = 0.0;
  for (const Shift& shift : shifts) left_m2 += static_cast<double>(shift.area_m2);
  left_m2 *= kCountedArea;
  for (const Shift& shift : shifts) {
    left_m2 -= static_cast<double>(shift.area_m2);
    if (left_m2 <= 0.0) return shift.length_m;
  }
  return 0.0F;
}

/// Carries texture points, colours and parts of a model over to its levels.
class Carrier {
 public:
  explicit Carrier(const Model& model)
      : model_(model), walk_(model.mesh), part_of_vertex_(model.mesh.vertices.size(), 0) {
    for (std::uint32_t p = 0; p < model.parts.size(); ++p)
      for (std::uint32_t t = 0; t < model.parts[p].triangle_count; ++t)
        for (const std::uint32_t vertex : model.mesh.triangles[model.parts[p].first_triangle + t])
          part_of_vertex_[vertex] = p;
  }

  /// Completes a level, and enlarges its deviation to the shift of the texture.
  void carry_over(LevelOfDetail& level) const {
    sort_by_part(level);
    const std::vector<SurfaceFoot> feet = set_points(level);
    std::vector<Shift> shifts;
    for (const Triangle& t : level.mesh.triangles) measure(level, t, feet, shifts);
    level.deviation_m = std::max(level.deviation_m, bound_of(shifts));
  }

 private:
  const Model& model_;
  SurfaceWalk walk_;
  std::vector<std::uint32_t> part_of_vertex_;

  void sort_by_part(LevelOfDetail& level) const {
    const auto part_of = [&](const Triangle& t) { return part_of_vertex_[level.full_vertex[t[0]]]; };
    std::stable_sort(level.mesh.triangles.begin(), level.mesh.triangles.end(),
                     [&](const Triangle& a, const Triangle& b) { return part_of(a) < part_of(b); });
    level.parts = model_.parts;
    for (ModelPart& part : level.parts) part.triangle_count = 0;
    for (const Triangle& t : level.mesh.triangles) ++level.parts[part_of(t)].triangle_count;
    std::uint32_t next = 0;
    for (ModelPart& part : level.parts) part.first_triangle = std::exchange(next, next + part.triangle_count);
  }

  /// Returns the points of the full mesh nearest to the level's vertices.
  std::vector<SurfaceFoot> set_points(LevelOfDetail& level) const {
    std::vector<SurfaceFoot> feet;
    level.texture_points.clear();
    level.mesh.colours.clear();
    for (std::size_t v = 0; v < level.mesh.vertices.size(); ++v) {
      const SurfaceFoot foot = walk_.nearest(walk_.triangle_at(level.full_vertex[v]), level.mesh.vertices[v]);
      feet.push_back(foot);
      level.texture_points.push_back(texture_point(foot));
      if (!model_.mesh.colours.empty()) level.mesh.colours.push_back(colour(foot));
    }
    return feet;
  }

  [[nodiscard]] Eigen::Vector2f texture_point(const SurfaceFoot& foot) const {
    const Triangle& t = model_.mesh.triangles[foot.triangle];
    const auto& points = model_.texture_points;
    return foot.weights.x() * points[t[0]] + foot.weights.y() * points[t[1]] +
           foot.weights.z() * points[t[2]];
  }

  [[nodiscard]] Rgb colour(const SurfaceFoot& foot) const {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = model_.mesh.triangles[foot.triangle][static_cast<std::size_t>(k)];
      const Rgb& own = model_.mesh.colours[vertex];
      sum += foot.weights[k] * Eigen::Vector3f(own.r, own.g, own.b);
    }
    const auto byte = [](float value) { return static_cast<std::uint8_t>(std::lround(value)); };
    return {byte(sum.x()), byte(sum.y()), byte(sum.z())};
  }

  /// Returns the length on the full mesh that a difference of texture points stands for; 0 where the texture
  /// has no extent.
  [[nodiscard]] float length_m(std::uint32_t triangle, const Eigen::Vector2f& difference) const {
    const Triangle& t = model_.mesh.triangles[triangle];
    const Eigen::Vector3f a = model_.mesh.vertices[t[0]];
    const Eigen::Vector3f ab = model_.mesh.vertices[t[1]] - a, ac = model_.mesh.vertices[t[2]] - a;
    Eigen::Matrix2f texture_of_edges;
    texture_of_edges.col(0) = model_.texture_points[t[1]] - model_.texture_points[t[0]];
    texture_of_edges.col(1) = model_.texture_points[t[2]] - model_.texture_points[t[0]];
    if (!(std::abs(texture_of_edges.determinant()) > 1e-12F)) return 0.0F;
    const Eigen::Vector2f parts = texture_of_edges.inverse() * difference;
    return (parts.x() * ab + parts.y() * ac).norm();
  }

  /// Appends the shifts in the middle of a level's triangle and of its edges.
  void measure(const LevelOfDetail& level, const Triangle& t, const std::vector<SurfaceFoot>& feet,
               std::vector<Shift>& shifts) const {
    const auto& at = level.mesh.vertices;
    const float area_m2 = 0.5F * (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]).norm();
    constexpr float kThird = 1.0F / 3.0F;
    for (const Eigen::Vector3f& weights :
         {Eigen::Vector3f(0.5F, 0.5F, 0.0F), Eigen::Vector3f(0.0F, 0.5F, 0.5F),
          Eigen::Vector3f(0.5F, 0.0F, 0.5F), Eigen::Vector3f(kThird, kThird, kThird)}) {
      const Eigen::Vector3f p = weights.x() * at[t[0]] + weights.y() * at[t[1]] + weights.z() * at[t[2]];
      const Eigen::Vector2f shown = weights.x() * level.texture_points[t[0]] +
                                    weights.y() * level.texture_points[t[1]] +
                                    weights.z() * level.texture_points[t[2]];
      const SurfaceFoot foot = walk_.nearest(feet[weights.x() > 0.0F ? t[0] : t[1]].triangle, p);
      shifts.push_back({length_m(foot.triangle, shown - texture_point(foot)), 0.25F * area_m2});
    }
  }
};

}  // namespace

void fit_normals(const Mesh& fine, float reach_m, float spacing_m, Mesh& coarse) {
  struct Sums {
    Eigen::Matrix3d weights = Eigen::Matrix3d::Zero();  // sums of products of two corners' weights, m^2
    Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();  // one row per corner
  };
  std::vector<Sums> sums(coarse.triangles.size());
  const MeshDistanceQuery coarse_surface(coarse, reach_m);
  double area_m2 = 0.0;
  std::uint32_t near = MeshDistanceQuery::kNoGuess;
  for (const Triangle& t : fine.triangles) {
    const Corners place = corners_of(fine.vertices, t), shown = corners_of(fine.normals, t);
    const Eigen::Vector3f facing = (place.b - place.a).cross(place.c - place.a);
    for_each_part(place, spacing_m, [&](const Eigen::Vector3f& at, float part_m2) {
      const Eigen::Vector3f normal = shown.at(at);
      const float length = normal.norm();
      if (!(length > 0.0F && std::isfinite(length))) return;
      const Eigen::Vector3f p = place.at(at);
      const auto nearest = coarse_surface.nearest_facing(p, facing, near);
      if (!nearest) return;
      const Eigen::Vector3d weights =
          weights_at(corners_of(coarse.vertices, coarse.triangles[*nearest]), p).cast<double>();
      const double weight_m2 = part_m2;
      sums[*nearest].weights += weight_m2 * weights * weights.transpose();
      sums[*nearest].normals += weight_m2 * weights * (normal / length).cast<double>().transpose();
      area_m2 += weight_m2;
    });
  }
  if (!(area_m2 > 0.0)) return;

  const auto vertices = static_cast<Eigen::Index>(coarse.vertices.size());
  const double own = kAsItWas * area_m2 / static_cast<double>(vertices);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d right_side(vertices, 3);
  for (Eigen::Index v = 0; v < vertices; ++v) {
    entries.emplace_back(v, v, own);
    right_side.row(v) = own * coarse.normals[static_cast<std::size_t>(v)].cast<double>().transpose();
  }
  for (std::size_t t = 0; t < sums.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t row = coarse.triangles[t][static_cast<std::size_t>(i)];
      right_side.row(row) += sums[t].normals.row(i);
      for (int j = 0; j < 3; ++j)
        entries.emplace_back(row, coarse.triangles[t][static_cast<std::size_t>(j)], sums[t].weights(i, j));
    }
  Eigen::SparseMatrix<double> weights(vertices, vertices);
  weights.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(weights);
  if (solver.info() != Eigen::Success) return;
  const Eigen::MatrixX3d fitted = solver.solve(right_side);
  for (std::size_t v = 0; v < coarse.normals.size(); ++v) {
    const Eigen::Vector3f normal = fitted.row(static_cast<Eigen::Index>(v)).transpose().cast<float>();
    const float length = normal.norm();
    if (length > 0.0F && std::isfinite(length)) coarse.normals[v] = normal / length;
  }
}

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

std::vector<LevelOfDetail> levels_of_detail(const Model& model) {
  if (!model.is_textured()) return levels_of_detail(model.mesh);
  std::vector<LevelOfDetail> levels;
  std::vector<LevelOfDetail> untextured = levels_of_detail(model.mesh, /*keeps_seams=*/true);
  if (untextured.empty()) return levels;
  const Carrier carrier(model);
  for (LevelOfDetail& level : untextured) {
    carrier.carry_over(level);
    // fewer triangles and no larger deviation
    while (!levels.empty() && levels.back().deviation_m >= level.deviation_m) levels.pop_back();
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace roomradar
