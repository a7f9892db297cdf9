// triangle_gap.cpp: corners within the other triangle, edges across edges, and separating planes.
#include "radar/geometry/triangle_gap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radar/geometry/infinity.hpp"

namespace roomradar {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using Sides = std::array<std::array<double, 3>, 3>;  // [edge][corner of the other]

double cross2(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Computes twice the signed areas of the corners of `other` with the edges of `t`, positive inside. Returns
/// false if all corners are outside one edge.
bool sides_of(const Corners& t, double sign, const Corners& other, double rounding_m2, Sides& sides) {
  for (std::size_t i = 0; i < 3; ++i) {
    double most = -1.0;
    for (std::size_t j = 0; j < 3; ++j) {
      sides[i][j] = sign * cross2(t[i], t[(i + 1) % 3], other[j]);
      most = j == 0 ? sides[i][j] : std::max(most, sides[i][j]);
    }
    if (sign != 0.0 && most < -rounding_m2) return false;
  }
  return true;
}

bool is_between(double a, double b, double rounding) {
  return (a >= -rounding && b <= rounding) || (a <= rounding && b >= -rounding);
}

/// Returns the height of t at corner j of the other triangle if the corner is inside.
std::optional<double> height_at(const Corners& t, const Sides& sides, std::size_t j, double rounding_m2) {
  // Edge i is opposite corner i + 2.
  const double w2 = sides[0][j], w0 = sides[1][j], w1 = sides[2][j];
  if (w0 < -rounding_m2 || w1 < -rounding_m2 || w2 < -rounding_m2) return std::nullopt;
  const double v0 = std::max(w0, 0.0), v1 = std::max(w1, 0.0), v2 = std::max(w2, 0.0);
  const double sum = v0 + v1 + v2;
  if (!(sum > 0.0)) return std::nullopt;
  return (v0 * t[0].z() + v1 * t[1].z() + v2 * t[2].z()) / sum;
}

}  // namespace

void set_normal(FrameTriangle& triangle) {
  const Corners& c = triangle.corners;
  triangle.normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const double norm = triangle.normal.norm();
  triangle.normal *= norm > 0.0 && std::isfinite(1.0 / norm) ? 1.0 / norm : 0.0;
}

bool find_gap(const FrameTriangle& object, const FrameTriangle& scene, TriangleGap& gap) {
  const Corners& o = object.corners;
  const Corners& s = scene.corners;
  gap.count = 0;
  double size_m = 0.0;
  for (int axis = 0; axis < 2; ++axis) {
    const auto [o_low, o_high] = std::minmax({o[0][axis], o[1][axis], o[2][axis]});
    const auto [s_low, s_high] = std::minmax({s[0][axis], s[1][axis], s[2][axis]});
    if (o_low > s_high || s_low > o_high) return false;
    size_m = std::max({size_m, o_high - o_low, s_high - s_low});
  }
  // Max rounding error of cross2 for corners this far apart.
  const double rounding_m2 = 4e-15 * size_m * size_m;
  const auto sign_of = [&](const Corners& t) {
    const double area_m2 = cross2(t[0], t[1], t[2]);
    if (std::abs(area_m2) <= rounding_m2) return 0.0;  // edge-on: handled by its edges alone
    return area_m2 > 0.0 ? 1.0 : -1.0;
  };
  const double o_sign = sign_of(o), s_sign = sign_of(s);
  Sides of_scene, of_object;
  if (!sides_of(s, s_sign, o, rounding_m2, of_scene)) return false;
  if (!sides_of(o, o_sign, s, rounding_m2, of_object)) return false;
  // Edge-on triangles have no inside, but the crossings need their sides.
  if (s_sign == 0.0) sides_of(s, 1.0, o, 1e300, of_scene);
  if (o_sign == 0.0) sides_of(o, 1.0, s, 1e300, of_object);

  const auto put = [&](double x, double y, double scene_z, double object_z) {
    gap.vertices[gap.count++] = {x, y, scene_z, scene_z - object_z};
  };
  for (std::size_t j = 0; j < 3; ++j) {
    if (s_sign != 0.0) {
      if (const auto z = height_at(s, of_scene, j, rounding_m2)) put(o[j].x(), o[j].y(), *z, o[j].z());
    }
    if (o_sign != 0.0) {
      if (const auto z = height_at(o, of_object, j, rounding_m2)) put(s[j].x(), s[j].y(), s[j].z(), *z);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double a = of_scene[i][j], b = of_scene[i][(j + 1) % 3];
      const double c = of_object[j][i], d = of_object[j][(i + 1) % 3];
      if (!is_between(a, b, rounding_m2) || !is_between(c, d, rounding_m2)) continue;
      if (std::abs(a - b) <= rounding_m2 || std::abs(c - d) <= rounding_m2) continue;  // parallel
      const double along_object = std::clamp(a / (a - b), 0.0, 1.0);
      const double along_scene = std::clamp(c / (c - d), 0.0, 1.0);
      const Eigen::Vector3d& o0 = o[j];
      const Eigen::Vector3d on_scene = s[i] + along_scene * (s[(i + 1) % 3] - s[i]);
      put(on_scene.x(), on_scene.y(), on_scene.z(), o0.z() + along_object * (o[(j + 1) % 3].z() - o0.z()));
    }
  }
  if (gap.count == 0) return false;
  gap.low_m = gap.high_m = gap.vertices[0].gap;
  gap.lowest = 0;
  for (std::size_t i = 1; i < gap.count; ++i) {
    if (gap.vertices[i].gap < gap.low_m) gap.low_m = gap.vertices[i].gap, gap.lowest = i;
    gap.high_m = std::max(gap.high_m, gap.vertices[i].gap);
  }
  return true;
}

double least_gap_bound(const FrameTriangle& object, const FrameTriangle& scene, double touching_m) {
  const auto& o = object.corners;
  const auto& s = scene.corners;
  const double by_height_m =
      std::min(std::min(s[0].z(), s[1].z()), s[2].z()) - std::max(std::max(o[0].z(), o[1].z()), o[2].z());
  if (std::abs(scene.normal.z()) <= kEdgeOn && !scene.normal.isZero(0.0)) {
    double low_m = kInfinity<double>, high_m = -kInfinity<double>;
    for (const Eigen::Vector3d& corner : o) {
      const double across_m = scene.normal.dot(corner - s[0]);
      low_m = std::min(low_m, across_m);
      high_m = std::max(high_m, across_m);
    }
    return low_m >= -touching_m || high_m <= touching_m ? kInfinity<double> : by_height_m;  // slides along it
  }
  if (std::abs(scene.normal.z()) < 1e-3) return by_height_m;
  const double per_m = 1.0 / scene.normal.z();
  double by_plane_m = kInfinity<double>, size_m = s[0].lpNorm<1>();
  for (const Eigen::Vector3d& corner : o) {
    by_plane_m = std::min(by_plane_m, scene.normal.dot(s[0] - corner) * per_m);
    size_m = std::max(size_m, corner.lpNorm<1>());
  }
  // Rounding of a difference, a product and a sum of three, and the tilt by the normal's own rounding.
  constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
  return std::max(by_height_m, by_plane_m - kRounding * size_m * std::abs(per_m));
}

PairContact classify_pair(const FrameTriangle& object, const FrameTriangle& scene, const TriangleGap& gap,
                          double touching_m) {
  const double facing = scene.normal.z();
  const bool is_edge_on = std::abs(facing) <= kEdgeOn;
  // Distances of the object's corners in front of the scene's plane (against the motion; for a plane seen
  // edge-on, on its outside), and of the scene's corners ahead of the object's plane.
  const auto heights = [](const FrameTriangle& plane, double sign, const FrameTriangle& other) {
    std::array<double, 2> low_high{1e300, -1e300};
    for (const Eigen::Vector3d& corner : other.corners) {
      const double height_m = sign * plane.normal.dot(corner - plane.corners[0]);
      low_high[0] = std::min(low_high[0], height_m);
      low_high[1] = std::max(low_high[1], height_m);
    }
    return low_high;
  };
  if (gap.high_m < -touching_m) return PairContact::kNone;
  const bool meets_now = gap.low_m <= touching_m;
  const bool has_scene_plane = !scene.normal.isZero(0.0);
  std::array<double, 2> before{-1e300, 1e300};
  if (has_scene_plane && (meets_now || is_edge_on))
    before = heights(scene, facing > 0.0 ? -1.0 : 1.0, object);
  if (is_edge_on && has_scene_plane) {
    // Slides along a plane parallel to the motion, now or later.
    if (before[0] >= -touching_m || before[1] <= touching_m) return PairContact::kNone;
  }
  if (!meets_now) return PairContact::kContact;
  const bool is_left = facing > kEdgeOn;
  if (is_left) {
    return gap.low_m < -touching_m && gap.high_m > touching_m ? PairContact::kLeaving : PairContact::kNone;
  }
  if (has_scene_plane && !is_edge_on) {
    if (before[0] >= -touching_m) return PairContact::kContact;
    if (before[1] <= touching_m) return PairContact::kNone;
  }
  const double object_facing = object.normal.z();
  if (std::abs(object_facing) > kEdgeOn) {
    const auto ahead = heights(object, object_facing > 0.0 ? 1.0 : -1.0, scene);
    if (ahead[0] >= -touching_m) return PairContact::kContact;
    if (ahead[1] <= touching_m) return PairContact::kNone;
  } else if (!object.normal.isZero(0.0)) {
    const auto beside = heights(object, 1.0, scene);
    if (beside[0] >= -touching_m || beside[1] <= touching_m) return PairContact::kNone;
  }
  if (gap.low_m >= -touching_m) return PairContact::kContact;
  return gap.high_m > touching_m ? PairContact::kCrossing : PairContact::kNone;
}

}  // namespace roomradar
