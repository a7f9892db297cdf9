// near_field.cpp: two trees side by side, and planes between pairs of triangles.
#include "radar/near_field.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "radar/thick_travel.hpp"
#include "radar/triangle_gap.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Until something that is allowed so far (m) and closes at this speed is there, if the turning adds
/// quadratic_m_s2 t^2 at most.
double time_for(double allowed_m, double closing_m_s, double quadratic_m_s2) {
  const double root = std::sqrt(closing_m_s * closing_m_s + 4.0 * quadratic_m_s2 * allowed_m);
  const double denominator = closing_m_s + root;
  return denominator > 0.0 ? 2.0 * allowed_m / denominator : kInfinity;
}

double allowed_m(double distance_m, double keep_m) {
  return distance_m > 2.0 * keep_m ? distance_m - keep_m : 0.5 * distance_m;
}

FrameTriangle triangle_of(const TriangleTree& tree, std::uint32_t i) {
  FrameTriangle t;
  for (std::size_t k = 0; k < 3; ++k)
    t.corners[k] = tree.vertices()[tree.triangles()[i][k]].cast<double>() - tree.centre();
  return t;
}

struct Range {
  double low = kInfinity, high = -kInfinity;
};
Range range_along(const Vec3& direction, const std::array<Vec3, 3>& corners) {
  Range range;
  for (const Vec3& corner : corners) {
    const double at = direction.dot(corner);
    range.low = std::min(range.low, at);
    range.high = std::max(range.high, at);
  }
  return range;
}

/// With what is asked of it again and again.
struct Face : FrameTriangle {
  std::array<Vec3, 3> edge, inward;  ///< from corner i on, and across it towards the third corner
};

Face face_of(const FrameTriangle& t) {
  Face face{t, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    face.edge[i] = t.corners[(i + 1) % 3] - t.corners[i];
    face.inward[i] = t.normal.cross(face.edge[i]);
  }
  return face;
}

bool is_over(const Vec3& p, const Face& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (t.inward[i].dot(p - t.corners[i]) < 0.0) return false;
  }
  return true;
}

bool pierces(const Vec3& a, const Vec3& b, const Face& t) {
  const double from = t.normal.dot(a - t.corners[0]), to = t.normal.dot(b - t.corners[0]);
  if (from * to > 0.0 || from == to) return false;
  return is_over(a + (b - a) * (from / (from - to)), t);
}

bool cross(const Face& a, const Face& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (pierces(a.corners[i], a.corners[(i + 1) % 3], b) || pierces(b.corners[i], b.corners[(i + 1) % 3], a))
      return true;
  }
  return false;
}

/// Of many places those that hold up most: for each of some normals the nearest, and in each direction across
/// the normal the outermost, where a place that is farther away has to be farther out.
void keep_the_outermost(std::vector<NearPoint>& all, std::vector<NearPoint>& kept) {
  constexpr double kOutPerGap = 20.0;  // 1 mm farther away is worth 2 cm farther out
  constexpr double kSameNormal = 0.9;
  constexpr std::size_t kMostNormals = 4, kDirections = 8;
  kept.clear();
  for (std::size_t cluster = 0; cluster < kMostNormals && !all.empty(); ++cluster) {
    const auto nearest = std::min_element(
        all.begin(), all.end(), [](const NearPoint& a, const NearPoint& b) { return a.gap_m < b.gap_m; });
    const NearPoint seed = *nearest;
    const Vec3 x = seed.normal_world.unitOrthogonal(), y = seed.normal_world.cross(x);
    std::array<double, kDirections> most;
    std::array<const NearPoint*, kDirections> outermost{};
    most.fill(-kInfinity);
    const auto is_of_cluster = [&](const NearPoint& p) {
      return p.normal_world.dot(seed.normal_world) > kSameNormal;
    };
    for (const NearPoint& p : all) {
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
    for (const NearPoint* p : outermost) {
      const bool is_new =
          p != nullptr && std::none_of(kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end(),
                                       [&](const NearPoint& other) {
                                         return (other.point_world - p->point_world).squaredNorm() < 1e-10;
                                       });
      if (is_new && kept.size() < NearField::kMostPoints) kept.push_back(*p);
    }
    if (kept.size() >= NearField::kMostPoints) return;
    std::erase_if(all, is_of_cluster);
  }
}

}  // namespace

/// Goes through all pairs of leaves' triangles that key(object box, scene box) gives a finite number for, and
/// boxes with the least first. Frame: the scene mesh's, about its tree's centre.
template <typename Key, typename Leaf>
void NearField::visit(const TriangleTree& object, const TriangleTree& scene,
                      const Eigen::Isometry3d& T_scene_object, const Key& key, const Leaf& leaf) {
  // Boxes hold what is in them with the rounding of a float turn and shift counted in.
  const Eigen::Matrix3f R = T_scene_object.linear().cast<float>();
  const Eigen::Matrix3f R_abs = R.cwiseAbs();
  const Eigen::Vector3f t = T_scene_object.translation().cast<float>();
  const float slack_m = 16.0F * std::numeric_limits<float>::epsilon() *
                        (t.lpNorm<Eigen::Infinity>() + object.half_size().norm() + scene.half_size().norm());
  const auto push = [&](const Box& o, const Box& s) {
    const float k = key(o, s);
    if (k < std::numeric_limits<float>::infinity()) pending_.push_back({o, s, k});
  };
  pending_.clear();
  const Eigen::Vector3f slack = Eigen::Vector3f::Constant(slack_m);
  push({t, R_abs * object.half_size() + slack, 0, 0},
       {Eigen::Vector3f::Zero(), scene.half_size() + slack, 0, 0});
  while (!pending_.empty()) {
    const Pair pair = pending_.back();
    pending_.pop_back();
    if (!(key(pair.object, pair.scene) < std::numeric_limits<float>::infinity())) continue;
    if (pair.object.count > 0 && pair.scene.count > 0) {
      leaf(pair.object, pair.scene);
      continue;
    }
    const bool opens_object =
        pair.scene.count > 0 ||
        (pair.object.count == 0 && pair.object.half.maxCoeff() > pair.scene.half.maxCoeff());
    const std::size_t first_new = pending_.size();
    const TreeNode& node = opens_object ? object.nodes()[pair.object.first] : scene.nodes()[pair.scene.first];
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      Box box{{node.centre_x[i], node.centre_y[i], node.centre_z[i]},
              {node.half_x[i], node.half_y[i], node.half_z[i]},
              node.first[i],
              node.count[i]};
      if (opens_object) {
        box.centre = R * box.centre + t;
        box.half = R_abs * box.half;
      }
      box.half += slack;
      opens_object ? push(box, pair.scene) : push(pair.object, box);
    }
    std::sort(pending_.begin() + static_cast<std::ptrdiff_t>(first_new), pending_.end(),
              [](const Pair& a, const Pair& b) { return a.key > b.key; });
  }
}

namespace {

constexpr std::size_t kLeafTriangles = 4;  // no leaf of a TriangleTree has more

/// From the object's mesh frame about its tree's centre to the scene's.
Eigen::Isometry3d between_centres(const TreeInstance& object, const TreeInstance& scene) {
  const Vec3 object_centre = object.tree->origin() + object.tree->centre();
  const Vec3 scene_centre = scene.tree->origin() + scene.tree->centre();
  const Eigen::Isometry3d T_scene_object = Eigen::Translation3d(-scene_centre) *
                                           scene.T_world_mesh.inverse() * object.T_world_mesh *
                                           Eigen::Translation3d(object_centre);
  return T_scene_object;
}

bool is_usable(const TreeInstance& instance) {
  return instance.tree != nullptr && !instance.tree->empty() && instance.T_world_mesh.matrix().allFinite();
}

FrameTriangle moved(const FrameTriangle& t, const Eigen::Isometry3d& T) {
  FrameTriangle result;
  for (std::size_t k = 0; k < 3; ++k) result.corners[k] = T * t.corners[k];
  set_normal(result);
  return result;
}

/// Whether a leaf's triangles may tell more of the other tree's box than their own box does.
template <typename Box>
bool are_large_against(const Box& leaf, const Box& other) {
  return leaf.count > 0 && leaf.half.maxCoeff() > 2.0F * other.half.maxCoeff();
}

/// Collects the places of one pair of triangles.
struct PairPlaces {
  double reach_m;
  bool object_is_closed;
  bool scene_is_one_sided;
  Touched kind;
  const Eigen::Isometry3d& T_world_frame;
  std::vector<NearPoint>& found;

  void add(const Vec3& on_scene, const Vec3& way, double gap_m) const {
    if (!(gap_m > 0.0 && gap_m <= reach_m)) return;
    found.push_back({T_world_frame * on_scene, T_world_frame.linear() * way / gap_m, gap_m, kind});
  }

  /// Returns whether the triangles cross.
  bool look(const Face& o, const Face& s) const {
    std::array<double, 3> over_scene,
        over_object;  // heights of the corners of the one above the other's plane
    double s_low = kInfinity, s_high = -kInfinity, o_low = kInfinity, o_high = -kInfinity;
    for (std::size_t k = 0; k < 3; ++k) {
      over_scene[k] = s.normal.dot(o.corners[k] - s.corners[0]);
      over_object[k] = o.normal.dot(s.corners[k] - o.corners[0]);
      s_low = std::min(s_low, over_scene[k]), s_high = std::max(s_high, over_scene[k]);
      o_low = std::min(o_low, over_object[k]), o_high = std::max(o_high, over_object[k]);
    }
    if (s_low > reach_m || s_high < -reach_m || o_low > reach_m || o_high < -reach_m) return false;
    if (scene_is_one_sided && s_low < 0.0) return false;
    if (object_is_closed && o_high < 0.0) return false;
    if (s_low < 0.0 && s_high > 0.0 && o_low < 0.0 && o_high > 0.0 && cross(o, s)) return true;
    for (std::size_t k = 0; k < 3; ++k) {
      const double h = over_scene[k], g = over_object[k];
      if (std::abs(h) <= reach_m && is_over(o.corners[k], s))
        add(o.corners[k] - h * s.normal, h * s.normal, std::abs(h));
      if (std::abs(g) <= reach_m && !(object_is_closed && g < 0.0) && is_over(s.corners[k], o))
        add(s.corners[k], -g * o.normal, std::abs(g));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      // Seen along the scene's normal, all of the scene's triangle may lie on one side of the edge.
      const Vec3 across = o.edge[i].cross(s.normal);
      const Range side = range_along(across, s.corners);
      const double at = across.dot(o.corners[i]), reach = reach_m * across.norm();
      if (side.low > at + reach || side.high < at - reach) continue;
      for (std::size_t j = 0; j < 3; ++j) look_at_edges(o, i, s, j);
    }
    return false;
  }

  /// Two edges that pass each other: the shortest way between them stands on both.
  void look_at_edges(const Face& o, std::size_t i, const Face& s, std::size_t j) const {
    const Vec3& a = o.corners[i];
    const Vec3& b = s.corners[j];
    const Vec3 &u = o.edge[i], &v = s.edge[j], w = a - b;
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
    const double across = uu * vv - uv * uv;
    if (!(across > 1e-6 * uu * vv)) return;  // parallel: their ends say it
    const double along_u = (uv * vw - uw * vv) / across, along_v = (uu * vw - uv * uw) / across;
    if (!(along_u > 0.0 && along_u < 1.0 && along_v > 0.0 && along_v < 1.0)) return;
    const Vec3 on_scene = b + along_v * v;
    const Vec3 way = a + along_u * u - on_scene;
    const double gap_m = way.norm();
    if (!(gap_m <= reach_m)) return;
    // The way leaves a closed object inwards: another of its faces is nearer.
    if (object_is_closed && way.dot(o.normal) > 1e-9 * gap_m) return;
    add(on_scene, way, gap_m);
  }
};

}  // namespace

Kinds NearField::near(const TreeInstance& object, const RadarScene& scene, double reach_m, Kinds left_out,
                      std::vector<NearPoint>& points) {
  points.clear();
  found_.clear();
  Kinds crossed = 0;
  if (!is_usable(object) || !(reach_m > 0.0)) return crossed;
  for (const SceneTree& tree : scene.trees) {
    if (!is_usable(tree.instance) || (left_out & bit_of(tree.kind)) != 0) continue;
    const std::size_t found_before = found_.size();
    bool crosses = false;
    const Eigen::Isometry3d T_scene_object = between_centres(object, tree.instance);
    const Eigen::Isometry3d T_world_frame =
        tree.instance.T_world_mesh *
        Eigen::Translation3d(tree.instance.tree->origin() + tree.instance.tree->centre());
    const PairPlaces places{
        reach_m, object.tree->is_closed(), is_one_sided(tree.kind), tree.kind, T_world_frame, found_};
    const auto reach = static_cast<float>(reach_m);
    const auto key = [&](const Box& o, const Box& s) -> float {
      const Eigen::Array3f apart = (o.centre - s.centre).array().abs() - o.half.array() - s.half.array();
      if (crosses || apart.maxCoeff() > reach) return std::numeric_limits<float>::infinity();
      const auto is_far_from = [&](const FrameTriangle& t, const Box& box) {
        return std::abs(t.normal.dot(box.centre.cast<double>() - t.corners[0])) -
                   t.normal.cwiseAbs().dot(box.half.cast<double>()) >
               reach_m;
      };
      if (are_large_against(o, s)) {
        for (std::uint32_t i = o.first; i < o.first + o.count; ++i)
          if (!is_far_from(moved(triangle_of(*object.tree, i), T_scene_object), s)) return 0.0F;
      } else if (are_large_against(s, o)) {
        for (std::uint32_t i = s.first; i < s.first + s.count; ++i) {
          FrameTriangle t = triangle_of(*tree.instance.tree, i);
          set_normal(t);
          if (!is_far_from(t, o)) return 0.0F;
        }
      } else {
        return 0.0F;
      }
      return std::numeric_limits<float>::infinity();
    };
    visit(*object.tree, *tree.instance.tree, T_scene_object, key, [&](const Box& o_box, const Box& s_box) {
      std::array<Face, kLeafTriangles> objects;
      assert(o_box.count <= kLeafTriangles);
      for (std::uint32_t i = 0; i < o_box.count; ++i)
        objects[i] = face_of(moved(triangle_of(*object.tree, o_box.first + i), T_scene_object));
      for (std::uint32_t j = s_box.first; j < s_box.first + s_box.count; ++j) {
        FrameTriangle corners = triangle_of(*tree.instance.tree, j);
        set_normal(corners);
        const Face s = face_of(corners);
        for (std::uint32_t i = o_box.first; i < o_box.first + o_box.count; ++i)
          crosses = places.look(objects[i - o_box.first], s) || crosses;
      }
    });
    if (!crosses) continue;
    crossed |= bit_of(tree.kind);
    found_.resize(found_before);
  }
  keep_the_outermost(found_, points);
  return crossed;
}

/// A rigid motion in the frame of a scene's mesh, and what holds for how it closes in.
struct NearField::Course {
  Vec3 linear, angular, centre;
  double turn_rad_s;
  double reach_m;  // from the centre to the farthest point of the object, across the axis
  double keep_m;

  [[nodiscard]] Vec3 velocity_at(const Vec3& p) const { return linear + angular.cross(p - centre); }
  /// Until boxes that axes keep apart can be as near as they may; 0 where none does.
  [[nodiscard]] float free_s(const Box& o, const Box& s) const {
    const Vec3 o_centre = o.centre.cast<double>(), o_half = o.half.cast<double>();
    const Vec3 between = o_centre - s.centre.cast<double>();
    const Vec3 velocity = velocity_at(o_centre);
    const Vec3 w = angular.cwiseAbs();
    double free_s = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double apart_m = std::abs(between[k]) - o_half[k] - static_cast<double>(s.half[k]);
      if (!(apart_m > 0.0)) continue;
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      const double spread = w[l] * o_half[m] + w[m] * o_half[l];
      const double side = between[k] > 0.0 ? 1.0 : -1.0;
      const double turning = std::hypot(angular[l], angular[m]);
      const double allowed = allowed_m(apart_m, keep_m);
      const double now =
          time_for(allowed, -side * velocity[k] + spread, 0.5 * turning * turn_rad_s * reach_m);
      const double ever = time_for(allowed, -side * linear[k] + turning * reach_m, 0.0);
      free_s = std::max({free_s, now, ever});
    }
    return static_cast<float>(free_s) * (1.0F - 1e-6F);
  }
  /// The same for a box and a triangle of the scene, by the triangle's plane.
  [[nodiscard]] double free_s(const FrameTriangle& s, const Box& o) const {
    const Vec3 middle = o.centre.cast<double>(), half = o.half.cast<double>();
    const double side = s.normal.dot(middle - s.corners[0]) >= 0.0 ? 1.0 : -1.0;
    const Vec3 direction = side * s.normal, turning = direction.cross(angular);
    const double apart_m = direction.dot(middle - s.corners[0]) - direction.cwiseAbs().dot(half);
    if (!(apart_m > 0.0)) return 0.0;
    const double closing = -direction.dot(velocity_at(middle)) + turning.cwiseAbs().dot(half);
    return time_for(allowed_m(apart_m, keep_m), closing, 0.5 * turning.norm() * turn_rad_s * reach_m);
  }
  /// The same for two triangles and a direction from the scene's to the object's: for each corner from where
  /// it is now. Negative where the direction does not keep them apart.
  [[nodiscard]] double free_s(const Vec3& direction, const FrameTriangle& o, const FrameTriangle& s) const {
    return free_s(direction, o, range_along(direction, s.corners).high);
  }
  /// The same for all that lies no farther along the direction than face_at.
  [[nodiscard]] double free_s(const Vec3& direction, const FrameTriangle& o, double face_at) const {
    const double turning = direction.cross(angular).norm();
    const double quadratic = 0.5 * turning * turn_rad_s * reach_m;
    const double fastest = -direction.dot(linear) + turning * reach_m;
    double free_s = kInfinity;
    for (const Vec3& corner : o.corners) {
      const double apart_m = direction.dot(corner) - face_at;
      if (!(apart_m > 0.0)) return -1.0;
      const double allowed = allowed_m(apart_m, keep_m);
      const double now = time_for(allowed, -direction.dot(velocity_at(corner)), quadratic);
      free_s = std::min(free_s, std::max(now, time_for(allowed, fastest, 0.0)));
    }
    return free_s;
  }
};

FreeTime NearField::free_time(const TreeInstance& object, const RigidMotion& motion, double duration_s,
                              double keep_m, const RadarScene& scene, Kinds left_out) {
  FreeTime result;
  if (!is_usable(object) || !(duration_s > 0.0)) return result;
  result.free_s = duration_s;
  double reach_m = 0.0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 side((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
    const Vec3 corner = object.tree->origin() + object.tree->centre() +
                        side.cwiseProduct(object.tree->half_size().cast<double>()) - motion.centre_object;
    reach_m = std::max(reach_m, corner.norm());
  }
  for (const SceneTree& tree : scene.trees) {
    if (!is_usable(tree.instance) || (left_out & bit_of(tree.kind)) != 0) continue;
    const Eigen::Isometry3d T_scene_object = between_centres(object, tree.instance);
    const Eigen::Isometry3d T_world_frame =
        tree.instance.T_world_mesh *
        Eigen::Translation3d(tree.instance.tree->origin() + tree.instance.tree->centre());
    const Eigen::Matrix3d R_frame_world = T_world_frame.linear().transpose();
    const Course course{R_frame_world * motion.linear_m_s,
                        R_frame_world * motion.angular_rad_s,
                        T_world_frame.inverse() * (object.T_world_mesh * motion.centre_object),
                        motion.angular_rad_s.norm(),
                        reach_m,
                        keep_m};
    const auto key = [&](const Box& o, const Box& s) -> float {
      const float free_s = course.free_s(o, s);
      if (!(static_cast<double>(free_s) < result.free_s)) return std::numeric_limits<float>::infinity();
      if (are_large_against(o, s)) {
        const Vec3 centre = s.centre.cast<double>(), half = s.half.cast<double>();
        for (std::uint32_t i = o.first; i < o.first + o.count; ++i) {
          const FrameTriangle t = moved(triangle_of(*object.tree, i), T_scene_object);
          const Vec3 direction = t.normal.dot(t.corners[0] - centre) >= 0.0 ? t.normal : Vec3(-t.normal);
          const double face_at = direction.dot(centre) + direction.cwiseAbs().dot(half);
          if (course.free_s(direction, t, face_at) < result.free_s) return free_s;
        }
      } else if (are_large_against(s, o)) {
        for (std::uint32_t i = s.first; i < s.first + s.count; ++i) {
          FrameTriangle t = triangle_of(*tree.instance.tree, i);
          set_normal(t);
          if (course.free_s(t, o) < result.free_s) return free_s;
        }
      } else {
        return free_s;
      }
      return std::numeric_limits<float>::infinity();
    };
    const auto look = [&](const FrameTriangle& o, const FrameTriangle& s) {
      double free_s = -1.0;
      const auto consider = [&](const Vec3& direction) {
        free_s = std::max(free_s, course.free_s(direction, o, s));
        return free_s >= result.free_s;
      };
      const double side_of_scene = s.normal.dot(o.corners[0] - s.corners[0]) >= 0.0 ? 1.0 : -1.0;
      if (is_one_sided(tree.kind) && range_along(s.normal, o.corners).low < s.normal.dot(s.corners[0]))
        return;
      const double side_of_object = o.normal.dot(s.corners[0] - o.corners[0]) >= 0.0 ? -1.0 : 1.0;
      if (consider(side_of_scene * s.normal) || consider(side_of_object * o.normal)) return;
      const auto [from, way] = shortest_way(o, s, 0.0);
      const double distance_m = way.norm();
      if (distance_m > 0.0 && consider(-way / distance_m)) return;
      if (free_s < 0.0) {
        if (!(distance_m > 0.0) || cross(face_of(o), face_of(s))) return;
        free_s = 0.0;  // so near that rounding hides the plane between them
      }
      if (!(distance_m > 0.0)) return;  // they touch: how they part is for contacts to say
      result.free_s = free_s;
      result.limit = {T_world_frame * (from + way), T_world_frame.linear() * (-way / distance_m), distance_m,
                      tree.kind};
    };
    visit(*object.tree, *tree.instance.tree, T_scene_object, key, [&](const Box& o_box, const Box& s_box) {
      for (std::uint32_t i = o_box.first; i < o_box.first + o_box.count; ++i) {
        const FrameTriangle o = moved(triangle_of(*object.tree, i), T_scene_object);
        for (std::uint32_t j = s_box.first; j < s_box.first + s_box.count; ++j) {
          FrameTriangle s = triangle_of(*tree.instance.tree, j);
          set_normal(s);
          look(o, s);
        }
      }
    });
  }
  return result;
}

}  // namespace roomradar
