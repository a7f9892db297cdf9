// closest_features.cpp: corners over faces, edges across edges, and selection of the outermost.
#include "radar/motion/closest_features.hpp"

#include <algorithm>
#include <cmath>

#include "radar/geometry/infinity.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;
constexpr double kTouching_m = 1e-12;  // below this, rounding decides the side

bool is_over(const Vec3& p, const Face& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (t.inward[i].dot(p - t.corners[i]) < 0.0) return false;
  }
  return true;
}

/// Returns true if p is farther than kTouching_m inside all edges.
bool is_inside(const Vec3& p, const Face& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (t.inward[i].dot(p - t.corners[i]) <= kTouching_m * t.inward[i].norm()) return false;
  }
  return true;
}

/// Returns +1 or -1; 0 within kTouching_m.
double side_of(double height_m) {
  if (std::abs(height_m) <= kTouching_m) return 0.0;
  return height_m > 0.0 ? 1.0 : -1.0;
}

/// Returns true if a unit normal leans towards a direction by more than 3 degrees. Where two faces lie nearly
/// flat on each other, their borders support them by normals that lean less.
bool is_towards(const Vec3& normal, const Vec3& direction) {
  constexpr double kLeans = 0.05;
  return normal.dot(direction) > kLeans * direction.norm();
}

struct DirectedEdge {
  Vec3 from, along;
};
/// Returns edge i of a triangle from its lesser end, by coordinates, to the other.
DirectedEdge edge_from_lesser_end(const Face& t, std::size_t i) {
  const Vec3 &a = t.corners[i], &b = t.corners[(i + 1) % 3];
  const bool is_from_a = std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  return is_from_a ? DirectedEdge{a, b - a} : DirectedEdge{b, a - b};
}

bool pierces(const Vec3& a, const Vec3& b, const Face& t) {
  const double from = t.normal.dot(a - t.corners[0]), to = t.normal.dot(b - t.corners[0]);
  if (from * to > 0.0 || from == to) return false;
  return is_over(a + (b - a) * (from / (from - to)), t);
}

}  // namespace

Face face_of(const FrameTriangle& t) {
  Face face{t, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    face.edge[i] = t.corners[(i + 1) % 3] - t.corners[i];
    face.inward[i] = t.normal.cross(face.edge[i]);
  }
  return face;
}

bool cross(const Face& a, const Face& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (pierces(a.corners[i], a.corners[(i + 1) % 3], b) || pierces(b.corners[i], b.corners[(i + 1) % 3], a))
      return true;
  }
  return false;
}

void FeatureCollector::add(const Vec3& on_scene, const Vec3& normal, double gap_m, const Face& s,
                           bool inside_is_nearer) const {
  if (normal.isZero() || !(gap_m <= reach_m)) return;
  if (scene_is_one_sided && !is_outside(normal, s)) return;
  (inside_is_nearer ? refused : found)
      .push_back({T_world_frame * on_scene, T_world_frame.linear() * normal, gap_m, kind});
}

void FeatureCollector::erase_refused() const {
  const auto key = [](const ClosestPoint& p) {
    const Vec3 &a = p.point_world, &b = p.normal_world;
    return std::array<double, 6>{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
  };
  const auto is_before = [&](const ClosestPoint& a, const ClosestPoint& b) { return key(a) < key(b); };
  std::sort(refused.begin(), refused.end(), is_before);
  std::erase_if(found, [&](const ClosestPoint& p) {
    return std::binary_search(refused.begin(), refused.end(), p, is_before);
  });
}

Vec3 FeatureCollector::off_scene(double height_m, const Face& o, const Face& s, const Range& heights) const {
  double side = side_of(height_m);
  // Touching: the object is on the side of the rest of its triangle. A triangle in the plane faces the scene.
  if (side == 0.0) side = side_of(heights.low + heights.high);
  if (side == 0.0 && object_is_closed) side = -side_of(o.normal.dot(s.normal));
  if (side == 0.0) side = 1.0;
  return side * s.normal;
}

Vec3 FeatureCollector::off_object(double height_m, const Vec3& corner, const Face& o,
                                  const Range& heights) const {
  double side = side_of(height_m);
  if (side == 0.0) {
    if (!is_inside(corner, o)) return Vec3::Zero();  // a corner along an edge is not supported by the face
    side = object_is_closed ? 1.0 : side_of(heights.low + heights.high);
  }
  return -side * o.normal;
}

bool FeatureCollector::look(const FrameTriangle& object, const FrameTriangle& scene) const {
  // Heights of each triangle's corners above the other's plane.
  std::array<double, 3> over_scene, over_object;
  Range of_object, of_scene;
  for (std::size_t k = 0; k < 3; ++k) {
    over_scene[k] = scene.normal.dot(object.corners[k] - scene.corners[0]);
    over_object[k] = object.normal.dot(scene.corners[k] - object.corners[0]);
    of_object.include(over_scene[k]);
    of_scene.include(over_object[k]);
  }
  if (of_object.low > reach_m || of_object.high < -reach_m || of_scene.low > reach_m ||
      of_scene.high < -reach_m)
    return false;
  if (scene_is_one_sided && of_object.high < -kTouching_m) return false;
  if (object_is_closed && of_scene.high < -kTouching_m) return false;
  const Face o = face_of(object), s = face_of(scene);
  if (of_object.low < 0.0 && of_object.high > 0.0 && of_scene.low < 0.0 && of_scene.high > 0.0 && cross(o, s))
    return !scene_is_one_sided;
  for (std::size_t k = 0; k < 3; ++k) {
    const double h = over_scene[k], g = over_object[k];
    if (std::abs(h) <= reach_m && is_over(o.corners[k], s))
      add(o.corners[k] - h * s.normal, off_scene(h, o, s, of_object), std::abs(h), s);
    if (std::abs(g) <= reach_m && !(object_is_closed && g < -kTouching_m) && is_over(s.corners[k], o)) {
      const Vec3 normal = off_object(g, s.corners[k], o, of_scene);
      const bool inside_is_nearer =
          is_towards(normal, s.edge[k]) || is_towards(normal, Vec3(-s.edge[(k + 2) % 3]));
      add(s.corners[k], normal, std::abs(g), s, inside_is_nearer);
    }
  }
  // Seen along the scene's normal, all of one triangle may lie on one side of an edge of the other.
  std::array<bool, 3> is_passed;  // the object is wholly beside this scene edge
  for (std::size_t j = 0; j < 3; ++j) {
    const Range side = range_along(s.inward[j], o.corners);
    const double at = s.inward[j].dot(s.corners[j]), reach = reach_m * s.inward[j].norm();
    is_passed[j] = side.low > at + reach || side.high < at - reach;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 across = o.edge[i].cross(s.normal);
    const Range side = range_along(across, s.corners);
    const double at = across.dot(o.corners[i]), reach = reach_m * across.norm();
    if (side.low > at + reach || side.high < at - reach) continue;
    for (std::size_t j = 0; j < 3; ++j)
      if (!is_passed[j]) look_at_edges(o, i, s, j);
  }
  return false;
}

/// Adds the shortest segment between two edges that pass each other; it is perpendicular to both.
void FeatureCollector::look_at_edges(const Face& o, std::size_t i, const Face& s, std::size_t j) const {
  // From the lesser end of each edge: the triangle beyond it finds the same point to the last bit.
  const auto [a, u] = edge_from_lesser_end(o, i);
  const auto [b, v] = edge_from_lesser_end(s, j);
  const Vec3 w = a - b;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double across = uu * vv - uv * uv;
  if (!(across > 1e-6 * uu * vv)) return;  // parallel: their end points give the closest features
  const double along_u = (uv * vw - uw * vv) / across, along_v = (uu * vw - uv * uw) / across;
  if (!(along_u > 0.0 && along_u < 1.0 && along_v > 0.0 && along_v < 1.0)) return;
  const Vec3 on_scene = b + along_v * v;
  const Vec3 way = a + along_u * u - on_scene;
  const double gap_m = way.norm();
  if (!(gap_m <= reach_m)) return;
  if (gap_m <= kTouching_m) {  // normal across both edges, towards the rest of the object's triangle
    const Vec3 normal = u.cross(v).normalized();
    return add(on_scene, side_of(normal.dot(o.corners[(i + 2) % 3] - a)) * normal, gap_m, s);
  }
  // The segment enters a closed object: another of its faces is nearer.
  if (object_is_closed && way.dot(o.normal) > 1e-9 * gap_m) return;
  const Vec3 normal = way / gap_m;
  add(on_scene, normal, gap_m, s, is_towards(normal, s.inward[j]));
}

void keep_the_outermost(std::vector<ClosestPoint>& all, std::vector<ClosestPoint>& kept) {
  constexpr double kOutPerGap = 20.0;  // 1 mm farther away must be 2 cm farther out
  constexpr double kSameNormal = 0.9;
  constexpr std::size_t kMostNormals = 4, kDirections = 8;
  kept.clear();
  for (std::size_t cluster = 0; cluster < kMostNormals && !all.empty(); ++cluster) {
    const auto nearest =
        std::min_element(all.begin(), all.end(),
                         [](const ClosestPoint& a, const ClosestPoint& b) { return a.gap_m < b.gap_m; });
    const ClosestPoint seed = *nearest;
    const Vec3 x = seed.normal_world.unitOrthogonal(), y = seed.normal_world.cross(x);
    std::array<double, kDirections> most;
    std::array<const ClosestPoint*, kDirections> outermost{};
    most.fill(-kInfinity<double>);
    const auto is_of_cluster = [&](const ClosestPoint& p) {
      return p.normal_world.dot(seed.normal_world) > kSameNormal;
    };
    for (const ClosestPoint& p : all) {
      if (!is_of_cluster(p)) continue;
      const Vec3 offset = p.point_world - seed.point_world;
      const double u = x.dot(offset), v = y.dot(offset), behind = kOutPerGap * (p.gap_m - seed.gap_m);
      constexpr double kDiagonal = 0.70710678118654752;
      const std::array<double, kDirections> out = {
          u, -u, v, -v, kDiagonal * (u + v), -kDiagonal * (u + v), kDiagonal * (u - v), kDiagonal * (v - u)};
      for (std::size_t i = 0; i < kDirections; ++i) {
        if (out[i] - behind > most[i]) {
          most[i] = out[i] - behind;
          outermost[i] = &p;
        }
      }
    }
    const std::size_t first = kept.size();
    kept.push_back(seed);
    for (const ClosestPoint* p : outermost) {
      const bool is_new =
          p != nullptr && std::none_of(kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end(),
                                       [&](const ClosestPoint& other) {
                                         return (other.point_world - p->point_world).squaredNorm() < 1e-10;
                                       });
      if (is_new && kept.size() < kMaxClosestPoints) kept.push_back(*p);
    }
    if (kept.size() >= kMaxClosestPoints) return;
    std::erase_if(all, is_of_cluster);
  }
}

}  // namespace roomradar
