// exact_clearance.cpp: vertices against faces, edges against edges, and solid angles, over all pairs.
#include "tests/support/exact_clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace roomradar {
namespace {

using Point = Eigen::Vector3d;
using Corners = std::array<Point, 3>;

/// Returns the triangles relative to the object's origin, which keeps the rounding of sums small.
std::vector<Corners> triangles_near(const Mesh& mesh, const Eigen::Isometry3d& T_world_mesh,
                                    const Point& origin_world) {
  const Point shift_world = T_world_mesh.linear() * mesh.origin + (T_world_mesh.translation() - origin_world);
  std::vector<Corners> result;
  for (const Triangle& triangle : mesh.triangles) {
    Corners corners;
    bool is_usable = true;
    for (std::size_t i = 0; i < 3 && is_usable; ++i) {
      is_usable = triangle[i] < mesh.vertices.size() && mesh.vertices[triangle[i]].allFinite();
      if (is_usable)
        corners[i] = T_world_mesh.linear() * mesh.vertices[triangle[i]].cast<double>() + shift_world;
    }
    if (is_usable) result.push_back(corners);
  }
  return result;
}

double squared_distance(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  return a.squaredExteriorDistance(b);
}

Eigen::AlignedBox3d box_of(const Corners& t) {
  Eigen::AlignedBox3d box;
  for (const Point& p : t) box.extend(p);
  return box;
}

/// Squared distance between the segments a b and c d: the distance of the two lines if its feet are inside
/// both segments, and the distances of the four ends, whichever is least.
double squared_distance_of_edges(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto to_segment = [](const Point& p, const Point& from, const Point& to) {
    const Point e = to - from;
    const double length2 = e.squaredNorm();
    const double s = length2 > 0.0 ? std::clamp((p - from).dot(e) / length2, 0.0, 1.0) : 0.0;
    return (from + s * e - p).squaredNorm();
  };
  double least =
      std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
  const Point u = b - a, v = d - c, w = c - a;
  const Point n = u.cross(v);
  const double n2 = n.squaredNorm();
  if (n2 > 0.0) {
    const double s = w.cross(v).dot(n) / n2, t = w.cross(u).dot(n) / n2;
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0)
      least = std::min(least, (w + t * v - s * u).squaredNorm());
  }
  return least;
}

/// Squared distance of p from the face if p's foot is inside the face, else infinity (the edges then
/// determine the distance).
double squared_distance_to_face(const Point& p, const Corners& t) {
  const Point n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double n2 = n.squaredNorm();
  for (std::size_t i = 0; i < 3; ++i) {
    if (n.dot((t[(i + 1) % 3] - t[i]).cross(p - t[i])) < 0.0) return std::numeric_limits<double>::infinity();
  }
  if (!(n2 > 0.0)) return std::numeric_limits<double>::infinity();
  const double height = n.dot(p - t[0]);
  return height * height / n2;
}

/// Returns true if the segment passes through the face.
bool pierces(const Point& a, const Point& b, const Corners& t) {
  const auto volume = [](const Point& p, const Point& q, const Point& r, const Point& s) {
    return (q - p).cross(r - p).dot(s - p);
  };
  if ((volume(t[0], t[1], t[2], a) > 0.0) == (volume(t[0], t[1], t[2], b) > 0.0)) return false;
  const double u = volume(a, b, t[0], t[1]), v = volume(a, b, t[1], t[2]), w = volume(a, b, t[2], t[0]);
  return (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
}

double squared_distance(const Corners& a, const Corners& b) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &a0 = a[i], &a1 = a[(i + 1) % 3];
    if (pierces(a0, a1, b) || pierces(b[i], b[(i + 1) % 3], a)) return 0.0;
    least = std::min({least, squared_distance_to_face(a0, b), squared_distance_to_face(b[i], a)});
    for (std::size_t j = 0; j < 3; ++j) {
      least = std::min(least, squared_distance_of_edges(a0, a1, b[j], b[(j + 1) % 3]));
    }
  }
  return least;
}

/// Winding number of the surface around the point.
double winding(const std::vector<Corners>& triangles, const Point& point) {
  double angle = 0.0;
  for (const Corners& t : triangles) {
    const Point a = t[0] - point, b = t[1] - point, c = t[2] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle +=
        2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4.0 * std::numbers::pi);
}

bool is_inside(const std::vector<Corners>& triangles, const Point& point) {
  return std::lround(winding(triangles, point)) % 2 != 0;
}

}  // namespace

double exact_clearance(const Mesh& object, const Eigen::Isometry3d& T_world_object, const Mesh& scene,
                       const Eigen::Isometry3d& T_world_scene, double at_most_m) {
  const Point origin_world = T_world_object * object.origin;
  const std::vector<Corners> object_triangles = triangles_near(object, T_world_object, origin_world);
  double least = at_most_m * at_most_m;
  Eigen::AlignedBox3d whole;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Corners& t : object_triangles) {
    boxes.push_back(box_of(t));
    whole.extend(boxes.back());
  }
  if (whole.isEmpty()) return at_most_m;
  for (const Corners& s : triangles_near(scene, T_world_scene, origin_world)) {
    const Eigen::AlignedBox3d box = box_of(s);
    if (squared_distance(box, whole) >= least) continue;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (squared_distance(box, boxes[i]) >= least) continue;
      least = std::min(least, squared_distance(object_triangles[i], s));
      if (least == 0.0) return 0.0;
    }
  }
  return std::sqrt(least);
}

bool exact_encloses(const Mesh& closed, const Eigen::Isometry3d& T_world_mesh, const Point& point_world) {
  return is_inside(triangles_near(closed, T_world_mesh, point_world), Point::Zero());
}

bool exact_holds_inside(const Mesh& closed_object, const Eigen::Isometry3d& T_world_object, const Mesh& scene,
                        const Eigen::Isometry3d& T_world_scene) {
  const Point origin_world = T_world_object * closed_object.origin;
  const std::vector<Corners> object_triangles = triangles_near(closed_object, T_world_object, origin_world);
  Eigen::AlignedBox3d whole;
  for (const Corners& t : object_triangles) whole.extend(box_of(t));
  for (const Corners& s : triangles_near(scene, T_world_scene, origin_world)) {
    for (const Point& p : s) {
      if (whole.contains(p) && is_inside(object_triangles, p)) return true;
    }
  }
  return false;
}

}  // namespace roomradar
