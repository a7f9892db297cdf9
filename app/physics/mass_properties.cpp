// mass_properties.cpp: sums over tetrahedra of a solid, triangles of a shell, or vertices.
#include "app/physics/mass_properties.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mapping/types/linear_algebra.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

/// Mass, first and second moments about the origin.
struct Moments {
  double mass = 0.0;
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  /// Adds a simplex of N corners with uniform density.
  template <std::size_t N>
  void add(const std::array<Vec3, N>& corners, double simplex_mass) {
    Vec3 sum = Vec3::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const Vec3& p : corners) {
      sum += p;
      squares += p * p.transpose();
    }
    mass += simplex_mass;
    first += simplex_mass / N * sum;
    second += simplex_mass / (N * (N + 1)) * (squares + sum * sum.transpose());
  }
};

MassProperties properties_of(const Moments& moments, const Vec3& from) {
  MassProperties result;
  const Vec3 centre = moments.first / moments.mass;
  const Eigen::Matrix3d covariance = moments.second / moments.mass - centre * centre.transpose();
  const Eigen::Matrix3d inertia = covariance.trace() * Eigen::Matrix3d::Identity() - covariance;
  const SymmetricEigen<3> axes = symmetric_eigen(inertia);
  constexpr double kLeastOfLargest = 1e-4, kLeast_m2 = 1e-12;
  const double least = std::max(kLeastOfLargest * axes.values.maxCoeff(), kLeast_m2);
  result.centre_object = from + centre;
  result.inertia_m2 = axes.vectors * axes.values.cwiseMax(least).asDiagonal() * axes.vectors.transpose();
  return result;
}

}  // namespace

MassProperties mass_properties(const Mesh& mesh, bool is_closed) {
  // Relative to the centre of the used vertices, to keep precision far from the mesh's origin.
  Eigen::AlignedBox3f box;
  for (const Triangle& t : mesh.triangles) {
    if (!is_usable(mesh, t)) continue;
    for (const std::uint32_t v : t) box.extend(mesh.vertices[v]);
  }
  if (box.isEmpty()) return {};
  const Vec3 middle = box.center().cast<double>();
  Moments solid, shell, points;
  for (const Triangle& t : mesh.triangles) {
    if (!is_usable(mesh, t)) continue;
    const auto at = [&](std::size_t i) -> Vec3 { return mesh.vertices[t[i]].cast<double>() - middle; };
    const Vec3 a = at(0), b = at(1), c = at(2);
    solid.add<4>({Vec3::Zero(), a, b, c}, a.dot(b.cross(c)) / 6.0);
    shell.add<3>({a, b, c}, 0.5 * (b - a).cross(c - a).norm());
    for (const Vec3& p : {a, b, c}) points.add<1>({p}, 1.0);
  }
  const double size_m = static_cast<double>(box.sizes().norm());
  const Vec3 from = mesh.origin + middle;
  const bool has_volume = is_closed && solid.mass > 1e-12 * size_m * size_m * size_m;
  const bool has_area = shell.mass > 1e-12 * size_m * size_m;
  MassProperties result = properties_of(has_volume ? solid : has_area ? shell : points, from);
  constexpr double kDensity_kg_m3 = 1000.0, kShell_kg_m2 = 5.0, kLeast_kg = 1e-3;
  result.mass_kg = std::max(has_volume ? kDensity_kg_m3 * solid.mass : kShell_kg_m2 * shell.mass, kLeast_kg);
  if (has_volume) result.volume_m3 = solid.mass;
  result.radius_m = 0.0;
  for (const Triangle& t : mesh.triangles) {
    if (!is_usable(mesh, t)) continue;
    for (const std::uint32_t v : t) {
      const Vec3 p = mesh.origin + mesh.vertices[v].cast<double>();
      result.radius_m = std::max(result.radius_m, (p - result.centre_object).norm());
    }
  }
  return result;
}

}  // namespace roomradar
