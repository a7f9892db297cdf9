// fit_normals.cpp: solves one linear least-squares problem for the normals of all vertices.
#include "app/objects/fit_normals.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "app/objects/triangle_weights.hpp"
#include "mapping/mesh/mesh_distance.hpp"

namespace roomradar {
namespace {

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

}  // namespace roomradar
