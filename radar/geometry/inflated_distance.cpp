// inflated_distance.cpp: closest points of two triangles, and steps along the plane between them.
#include "radar/geometry/inflated_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radar/geometry/infinity.hpp"

namespace roomradar {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// Shortest segment found so far from one set to another.
struct Shortest {
  ShortestWay best;
  double length2 = kInfinity<double>;

  void see(const Eigen::Vector3d& from, const Eigen::Vector3d& way) {
    const double candidate2 = way.squaredNorm();
    if (candidate2 < length2) {
      length2 = candidate2;
      best = {from, way};
    }
  }
};

/// Considers the segment between the edges a, a + u and b, b + v. Source: Ericson, Real-Time Collision
/// Detection, 2004, 5.1.9.
void see_edges(const Eigen::Vector3d& a, const Eigen::Vector3d& u, const Eigen::Vector3d& b,
               const Eigen::Vector3d& v, Shortest& shortest) {
  const Eigen::Vector3d w = a - b;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double across = uu * vv - uv * uv;
  double s = across > 0.0 ? std::clamp((uv * vw - uw * vv) / across, 0.0, 1.0) : 0.0;
  const double t = vv > 0.0 ? std::clamp((uv * s + vw) / vv, 0.0, 1.0) : 0.0;
  if (uu > 0.0) s = std::clamp((uv * t - uw) / uu, 0.0, 1.0);
  shortest.see(a + s * u, t * v - s * u - w);
}

/// Considers the segments from the corners of `from` to their feet on the face of `t`. sign 1: directed to t;
/// -1: directed away from it.
void see_face(const Corners& from, const FrameTriangle& t, double sign, Shortest& shortest) {
  if (t.normal.isZero(0.0)) return;
  const Eigen::Vector3d& n = t.normal;
  std::array<Eigen::Vector3d, 3> inward;
  for (std::size_t i = 0; i < 3; ++i) inward[i] = n.cross(t.corners[(i + 1) % 3] - t.corners[i]);
  for (const Eigen::Vector3d& p : from) {
    bool is_over = true;
    for (std::size_t i = 0; i < 3 && is_over; ++i) is_over = inward[i].dot(p - t.corners[i]) >= 0.0;
    if (!is_over) continue;
    const Eigen::Vector3d to_face = -n.dot(p - t.corners[0]) * n;
    shortest.see(sign > 0.0 ? p : Eigen::Vector3d(p + to_face), sign * to_face);
  }
}

}  // namespace

ShortestWay shortest_way(const FrameTriangle& object, const FrameTriangle& scene, double contact_distance_m) {
  FrameTriangle moved = object;
  for (Eigen::Vector3d& corner : moved.corners) corner.z() += contact_distance_m;
  Shortest shortest;
  see_face(moved.corners, scene, 1.0, shortest);
  see_face(scene.corners, moved, -1.0, shortest);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& a = moved.corners[i];
    const Eigen::Vector3d u = moved.corners[(i + 1) % 3] - a;
    for (std::size_t j = 0; j < 3; ++j) {
      const Eigen::Vector3d& b = scene.corners[j];
      see_edges(a, u, b, scene.corners[(j + 1) % 3] - b, shortest);
    }
  }
  return shortest.best;
}

double inflated_distance(const FrameTriangle& object, const FrameTriangle& scene, double margin_m,
                         double limit_m) {
  Eigen::Array3d object_low = object.corners[0], object_high = object.corners[0];
  Eigen::Array3d scene_low = scene.corners[0], scene_high = scene.corners[0];
  for (std::size_t i = 1; i < 3; ++i) {
    object_low = object_low.min(object.corners[i].array());
    object_high = object_high.max(object.corners[i].array());
    scene_low = scene_low.min(scene.corners[i].array());
    scene_high = scene_high.max(scene.corners[i].array());
  }
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    if (object_low[axis] - margin_m > scene_high[axis] || scene_low[axis] > object_high[axis] + margin_m) {
      return kInfinity<double>;
    }
  }
  if (object_low.z() - margin_m > scene_high.z()) return kInfinity<double>;  // the scene is behind

  TriangleGap gap;
  if (find_gap(object, scene, gap)) {
    if (gap.low_m <= 0.0 && gap.high_m >= 0.0) return 0.0;
  }
  double contact_distance_m = std::max(scene_low.z() - object_high.z() - margin_m, 0.0);
  constexpr int kSteps = 20;
  constexpr double kClose_m = 1e-10;
  for (int step = 0; step < kSteps && contact_distance_m < limit_m; ++step) {
    const Eigen::Vector3d way = shortest_way(object, scene, contact_distance_m).way;
    const double distance_m = way.norm();
    if (!(distance_m > margin_m + kClose_m)) return contact_distance_m;
    if (!(way.z() > 0.0)) return kInfinity<double>;  // the distance only grows from here
    contact_distance_m += (distance_m - margin_m) / (way.z() / distance_m) * (1.0 - 1e-9);
  }
  return contact_distance_m;
}

}  // namespace roomradar
