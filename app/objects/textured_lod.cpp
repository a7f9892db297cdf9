// textured_lod.cpp: transfers texture coordinates to simplified meshes, and measures the texture's shift.
#include "app/objects/textured_lod.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "app/objects/triangle_weights.hpp"
#include "mapping/mesh/triangle_distance.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {
namespace {

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
