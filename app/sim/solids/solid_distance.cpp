// solid_distance.cpp: GJK: the point of the Minkowski difference nearest to the origin, by simplices.
#include "app/sim/solids/solid_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomradar {
namespace {

using Eigen::Vector3d;

/// Returns the farthest point of the solid's core along a direction.
Vector3d core_support_world(const Solid& solid, const Vector3d& direction_world) {
  const Vector3d d = solid.T_world_solid.linear().transpose() * direction_world;
  Vector3d p_solid;
  const auto towards = [](double of, double half_m) { return of < 0.0 ? -half_m : half_m; };
  if (solid.shape == SolidShape::kBox) {
    for (int axis = 0; axis < 3; ++axis) p_solid[axis] = towards(d[axis], solid.half_m[axis]);
  } else {
    const double radial = std::hypot(d.x(), d.y());
    const double radius_m = radial > 0.0 ? solid.half_m.x() / radial : 0.0;
    p_solid = {d.x() * radius_m, d.y() * radius_m, towards(d.z(), solid.half_m.z())};
  }
  return solid.T_world_solid * p_solid;
}

/// A point of the Minkowski difference a - b, and the point of b it came from.
struct Corner {
  Vector3d w, b;
};

/// Up to four vertices, and the weights of the point nearest to the origin.
struct Simplex {
  std::array<Corner, 4> corners;
  std::array<double, 4> weights{};
  int size = 0;

  void keep(std::initializer_list<int> which, std::initializer_list<double> with) {
    const std::array<Corner, 4> old = corners;
    size = 0;
    for (const int i : which) corners[static_cast<std::size_t>(size++)] = old[static_cast<std::size_t>(i)];
    std::copy(with.begin(), with.end(), weights.begin());
  }
  [[nodiscard]] const Vector3d& w(int i) const { return corners[static_cast<std::size_t>(i)].w; }
  [[nodiscard]] Vector3d nearest() const {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < size; ++i) sum += weights[static_cast<std::size_t>(i)] * w(i);
    return sum;
  }
  [[nodiscard]] Vector3d point_b() const {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < size; ++i)
      sum += weights[static_cast<std::size_t>(i)] * corners[static_cast<std::size_t>(i)].b;
    return sum;
  }
};

/// Reduces a triangle to the feature nearest to the origin, by Voronoi regions. Source: Ericson, Real-Time
/// Collision Detection, 2005, section 5.1.5.
void reduce_triangle(Simplex& s, int ia, int ib, int ic) {
  const Vector3d a = s.w(ia), b = s.w(ib), c = s.w(ic), ab = b - a, ac = c - a;
  const double d1 = -ab.dot(a), d2 = -ac.dot(a);
  if (d1 <= 0.0 && d2 <= 0.0) return s.keep({ia}, {1.0});
  const double d3 = -ab.dot(b), d4 = -ac.dot(b);
  if (d3 >= 0.0 && d4 <= d3) return s.keep({ib}, {1.0});
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double t = d1 / (d1 - d3);
    return s.keep({ia, ib}, {1.0 - t, t});
  }
  const double d5 = -ab.dot(c), d6 = -ac.dot(c);
  if (d6 >= 0.0 && d5 <= d6) return s.keep({ic}, {1.0});
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double t = d2 / (d2 - d6);
    return s.keep({ia, ic}, {1.0 - t, t});
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return s.keep({ib, ic}, {1.0 - t, t});
  }
  const double sum = va + vb + vc;
  s.keep({ia, ib, ic}, {va / sum, vb / sum, vc / sum});
}

/// Reduces the simplex to the feature nearest to the origin. Returns false if the origin is inside a
/// tetrahedron.
bool reduce(Simplex& s) {
  switch (s.size) {
    case 1:
      s.weights[0] = 1.0;
      return true;
    case 2: {
      const Vector3d ab = s.w(1) - s.w(0);
      const double length2 = ab.squaredNorm();
      const double t = length2 > 0.0 ? -s.w(0).dot(ab) / length2 : 0.0;
      if (t <= 0.0) {
        s.keep({0}, {1.0});
      } else if (t >= 1.0) {
        s.keep({1}, {1.0});
      } else {
        s.keep({0, 1}, {1.0 - t, t});
      }
      return true;
    }
    case 3:
      reduce_triangle(s, 0, 1, 2);
      return true;
    default: {
      constexpr std::array<std::array<int, 4>, 4> kFaces{
          {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}}};  // a face, and the fourth vertex
      Simplex best;
      double best2 = -1.0;
      for (const auto& [ia, ib, ic, other] : kFaces) {
        const Vector3d normal = (s.w(ib) - s.w(ia)).cross(s.w(ic) - s.w(ia));
        const double origin_side = -s.w(ia).dot(normal), other_side = (s.w(other) - s.w(ia)).dot(normal);
        if (origin_side * other_side > 0.0) continue;  // the origin is on the inner side of this face
        Simplex face = s;
        reduce_triangle(face, ia, ib, ic);
        const double distance2 = face.nearest().squaredNorm();
        if (best2 < 0.0 || distance2 < best2) {
          best = face;
          best2 = distance2;
        }
      }
      if (best2 < 0.0) return false;
      s = best;
      return true;
    }
  }
}

}  // namespace

Separation separation(const Solid& a, const Solid& b) {
  constexpr double kTight_m = 1e-10, kTouching_m = 1e-11;
  constexpr int kRounds = 100;  // polytopes take a handful, rounded ends about twenty
  const double round_m = a.round_m + b.round_m;
  Simplex simplex;
  Vector3d v = a.T_world_solid.translation() - b.T_world_solid.translation();
  if (v.squaredNorm() == 0.0) v = Vector3d::UnitX();
  double bound_m = 0.0;  // lower bound of the cores' distance
  for (int round = 0; round < kRounds; ++round) {
    const Vector3d b_world = core_support_world(b, v);
    const Vector3d w = core_support_world(a, -v) - b_world;
    const double length_m = v.norm();
    if (simplex.size > 0) {
      bound_m = std::max(bound_m, v.dot(w) / length_m);
      if (length_m - bound_m <= kTight_m) break;
    }
    simplex.corners[static_cast<std::size_t>(simplex.size++)] = {w, b_world};
    if (!reduce(simplex)) return {};
    const Vector3d nearer = simplex.nearest();
    if (nearer.norm() <= kTouching_m) return {};
    if (round > 0 && nearer.squaredNorm() >= v.squaredNorm()) break;  // no progress, due to rounding
    v = nearer;
  }
  Separation result;
  result.normal_world = v.normalized();
  result.distance_m = std::max(0.0, bound_m - round_m);
  result.point_b_world = simplex.point_b() + b.round_m * result.normal_world;
  return result;
}

Eigen::AlignedBox3d bounds_world(const Solid& solid) {
  const Vector3d half_m =
      solid.T_world_solid.linear().cwiseAbs() * solid.half_m + Vector3d::Constant(solid.round_m);
  const Vector3d middle_world = solid.T_world_solid.translation();
  return {middle_world - half_m, middle_world + half_m};
}

double clearance_m(std::span<const Solid> obstacles, std::span<const Solid> parts,
                   const Eigen::Isometry3d& T_world_object, double enough_m) {
  double least_m = enough_m;
  for (Solid part : parts) {
    part.T_world_solid = T_world_object * part.T_world_solid;
    const Eigen::AlignedBox3d bounds = bounds_world(part);
    for (const Solid& obstacle : obstacles) {
      if (bounds.exteriorDistance(bounds_world(obstacle)) >= least_m) continue;
      least_m = std::min(least_m, separation(part, obstacle).distance_m);
    }
  }
  return least_m;
}

}  // namespace roomradar
