// free_time.cpp: the times for which planes between pairs of triangles keep a motion free of contact.
#include "radar/motion/free_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "radar/geometry/infinity.hpp"
#include "radar/geometry/inflated_distance.hpp"
#include "radar/geometry/tree_pairs.hpp"
#include "radar/motion/closest_features.hpp"
#include "radar/motion/local_surface.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

/// Returns the time until a point has approached by allowed_m. It closes in at closing_m_s now, and rotation
/// adds at most quadratic_m_s2 t^2.
double time_for(double allowed_m, double closing_m_s, double quadratic_m_s2) {
  const double root = std::sqrt(closing_m_s * closing_m_s + 4.0 * quadratic_m_s2 * allowed_m);
  if (closing_m_s < 0.0)
    return quadratic_m_s2 > 0.0 ? (root - closing_m_s) / (2.0 * quadratic_m_s2) : kInfinity<double>;
  const double denominator = closing_m_s + root;
  return denominator > 0.0 ? 2.0 * allowed_m / denominator : kInfinity<double>;
}

/// Returns true if time_for() is at least enough_s, without its square root.
bool is_enough(double enough_s, double allowed_m, double closing_m_s, double quadratic_m_s2) {
  return enough_s * (closing_m_s + quadratic_m_s2 * enough_s) <= allowed_m;
}

/// Returns the distance by which a pair may approach. At least a hundredth of keep_m remains, because
/// rounding would hide a plane in a smaller gap.
double allowed_m(double distance_m, double keep_m) {
  constexpr double kNearest = 0.01;  // fraction of keep_m
  if (distance_m > 2.0 * keep_m) return distance_m - keep_m;
  return std::max(0.0, 0.5 * (distance_m - kNearest * keep_m));
}

/// The object's motion relative to a tree of the scene, in the tree's frame, with bounds of its approach.
struct RelativeMotion {
  Vec3 linear, angular, centre;
  double turn_rad_s;
  double reach_m;  // from the centre to the farthest point of the object
  double keep_m;
  double tree_quadratic_m_s2;  // displacement by the tree's rotation: at most this times t^2
  bool tree_moves;             // if so, only the bound at present speed holds
  /// Displacement by rotation along each axis of the frame: at most quadratic_m_s2 t^2 beyond the present
  /// velocity, and at most fastest_m_s t.
  Vec3 quadratic_m_s2, fastest_m_s;
  double speed_m_s;  ///< of the object's points: at most this, within the duration

  [[nodiscard]] Vec3 velocity_at(const Vec3& p) const { return linear + angular.cross(p - centre); }
  /// Returns the time until two boxes separated along an axis can reach their minimum distance; 0 if no axis
  /// separates them, and infinity if the time is at least enough_s.
  [[nodiscard]] float free_s(const PairBox& o, const PairBox& s, double enough_s) const {
    const Vec3 o_centre = o.centre.cast<double>(), o_half = o.half.cast<double>();
    const Vec3 between = o_centre - s.centre.cast<double>();
    const Vec3 velocity = velocity_at(o_centre);
    const Vec3 w = angular.cwiseAbs();
    const Vec3 apart_m = between.cwiseAbs() - o_half - s.half.cast<double>();
    const Vec3 side(between.x() > 0.0 ? 1.0 : -1.0, between.y() > 0.0 ? 1.0 : -1.0,
                    between.z() > 0.0 ? 1.0 : -1.0);
    const Vec3 spread_m_s(w.y() * o_half.z() + w.z() * o_half.y(), w.z() * o_half.x() + w.x() * o_half.z(),
                          w.x() * o_half.y() + w.y() * o_half.x());
    const Vec3 closing_m_s = spread_m_s - side.cwiseProduct(velocity);
    const Vec3 fastest = fastest_m_s - side.cwiseProduct(linear);
    Vec3 allowed;
    for (int k = 0; k < 3; ++k) {
      allowed[k] = allowed_m(apart_m[k], keep_m);
      if (!(apart_m[k] > 0.0)) continue;
      if (!tree_moves && enough_s * fastest[k] <= allowed[k]) return kInfinity<float>;
      if (is_enough(enough_s, allowed[k], closing_m_s[k], quadratic_m_s2[k])) return kInfinity<float>;
    }
    double free_s = 0.0;
    for (int k = 0; k < 3; ++k) {
      if (!(apart_m[k] > 0.0)) continue;
      const double now = time_for(allowed[k], closing_m_s[k], quadratic_m_s2[k]);
      const double ever = tree_moves ? 0.0 : time_for(allowed[k], fastest[k], 0.0);
      free_s = std::max({free_s, now, ever});
    }
    return static_cast<float>(free_s) * (1.0F - 1e-6F);
  }
  /// Returns true if the plane of a scene triangle separates it from the box for enough_s.
  [[nodiscard]] bool separates_for(double enough_s, const FrameTriangle& s, const PairBox& o) const {
    const Vec3 middle = o.centre.cast<double>(), half = o.half.cast<double>();
    const double side = s.normal.dot(middle - s.corners[0]) >= 0.0 ? 1.0 : -1.0;
    const Vec3 direction = side * s.normal, turning = direction.cross(angular);
    const double apart_m = direction.dot(middle - s.corners[0]) - direction.cwiseAbs().dot(half);
    if (!(apart_m > 0.0)) return false;
    const double closing_m_s = -direction.dot(velocity_at(middle)) + turning.cwiseAbs().dot(half);
    return is_enough(enough_s, allowed_m(apart_m, keep_m), closing_m_s,
                     0.5 * turning.norm() * turn_rad_s * reach_m + tree_quadratic_m_s2);
  }
  /// Bounds of the approach of the object's points to a plane perpendicular to the direction: beyond the
  /// present velocity at most quadratic_m_s2 t^2, and at most fastest_m_s t.
  struct Approach {
    double quadratic_m_s2, fastest_m_s;
  };
  [[nodiscard]] Approach approach_along(const Vec3& direction) const {
    const double turning = direction.cross(angular).norm();
    return {0.5 * turning * turn_rad_s * reach_m + tree_quadratic_m_s2,
            -direction.dot(linear) + turning * reach_m};
  }
  /// Returns true if the object's triangle stays farther along the direction than face_at for enough_s.
  [[nodiscard]] bool separates_for(double enough_s, const Vec3& direction, const FrameTriangle& o,
                                   double face_at) const {
    const auto [quadratic, fastest] = approach_along(direction);
    for (const Vec3& corner : o.corners) {
      const double apart_m = direction.dot(corner) - face_at;
      if (!(apart_m > 0.0)) return false;
      const double allowed = allowed_m(apart_m, keep_m);
      if (!tree_moves && enough_s * fastest <= allowed) continue;
      if (!is_enough(enough_s, allowed, -direction.dot(velocity_at(corner)), quadratic)) return false;
    }
    return true;
  }
  /// Returns the time for two triangles and a direction from the scene's to the object's, the least over the
  /// corners. Negative if the direction does not separate them.
  [[nodiscard]] double free_s(const Vec3& direction, const FrameTriangle& o, const FrameTriangle& s) const {
    const double face_at = range_along(direction, s.corners).high;
    const auto [quadratic, fastest] = approach_along(direction);
    double free_s = kInfinity<double>;
    for (const Vec3& corner : o.corners) {
      const double apart_m = direction.dot(corner) - face_at;
      if (!(apart_m > 0.0)) return -1.0;
      const double allowed = allowed_m(apart_m, keep_m);
      const double now = time_for(allowed, -direction.dot(velocity_at(corner)), quadratic);
      free_s = std::min(free_s, tree_moves ? now : std::max(now, time_for(allowed, fastest, 0.0)));
    }
    return free_s;
  }

  /// Returns the time for two triangles and a plane between them that turns: its normal changes at
  /// turning_1_s. Such a plane follows a body that rocks on an edge or a corner. Negative if the plane does
  /// not separate them.
  /// @param duration_s  upper bound of the time
  [[nodiscard]] double free_s(const Vec3& direction, const Vec3& turning_1_s, const FrameTriangle& o,
                              const FrameTriangle& s, double duration_s) const {
    double farthest_m = 0.0;
    for (const Vec3& on_object : o.corners)
      for (const Vec3& on_scene : s.corners) farthest_m = std::max(farthest_m, (on_object - on_scene).norm());
    farthest_m += speed_m_s * duration_s;
    const double turning = turning_1_s.norm();
    const double quadratic = 0.5 * turning * (turning * farthest_m + 2.0 * speed_m_s) +
                             0.5 * turn_rad_s * turn_rad_s * reach_m + tree_quadratic_m_s2;
    double free_s = kInfinity<double>;
    for (const Vec3& on_object : o.corners) {
      const double away_m_s = direction.dot(velocity_at(on_object));
      for (const Vec3& on_scene : s.corners) {
        const Vec3 between = on_object - on_scene;
        const double apart_m = direction.dot(between);
        if (!(apart_m > 0.0)) return -1.0;
        const double closing_m_s = -(away_m_s + turning_1_s.dot(between));
        free_s = std::min(free_s, time_for(allowed_m(apart_m, keep_m), closing_m_s, quadratic));
      }
    }
    return free_s;
  }
  /// Returns the longest time for turning planes that start perpendicular to `direction`. One turns with the
  /// object; the other keeps containing the nearest edges of the two triangles.
  [[nodiscard]] double free_s_turning(const Vec3& direction, const FrameTriangle& o, const FrameTriangle& s,
                                      double duration_s) const {
    const double with_object = free_s(direction, angular.cross(direction), o, s, duration_s);
    const auto is_lower = [&](const Vec3& a, const Vec3& b) { return direction.dot(a) < direction.dot(b); };
    std::array<Vec3, 3> lowest = o.corners, highest = s.corners;
    std::sort(lowest.begin(), lowest.end(), is_lower);
    std::sort(highest.begin(), highest.end(), [&](const Vec3& a, const Vec3& b) { return is_lower(b, a); });
    const Vec3 edge = lowest[1] - lowest[0], across = direction.cross(highest[1] - highest[0]);
    const double meet = across.dot(edge);
    constexpr double kParallel = 1e-3;
    if (!(std::abs(meet) > kParallel * across.norm() * edge.norm())) return with_object;
    const Vec3 turning_1_s = -direction.dot(angular.cross(edge)) / meet * across;
    return std::max(with_object, free_s(direction, turning_1_s, o, s, duration_s));
  }
};

/// Returns the distance from the centre of rotation to the farthest corner of the tree's box.
double reach_of(const TriangleTree& tree, const Vec3& centre) {
  double reach_m = 0.0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 side((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
    const Vec3 corner =
        tree.origin() + tree.centre() + side.cwiseProduct(tree.half_size().cast<double>()) - centre;
    reach_m = std::max(reach_m, corner.norm());
  }
  return reach_m;
}

bool is_still(const RigidMotion& motion) {
  return motion.linear_m_s.isZero(0.0) && motion.angular_rad_s.isZero(0.0);
}

/// Returns the greatest distance that a point of the mesh travels.
double path_m(const TreeInstance& instance, const RigidMotion& motion, double duration_s) {
  if (is_still(motion)) return 0.0;
  const double reach_m = reach_of(*instance.tree, motion.centre_object);
  return duration_s * (motion.linear_m_s.norm() + motion.angular_rad_s.norm() * reach_m);
}

RelativeMotion relative_motion(const MovingTree& moving_object, const MovingTree& moving_tree,
                               double duration_s, double keep_m, const TreePair& trees) {
  const auto& [object, motion] = moving_object;
  const auto& [tree, tree_motion] = moving_tree;
  const Vec3 centre_world = object.T_world_mesh * motion.centre_object;
  Vec3 linear_world = motion.linear_m_s, angular_world = motion.angular_rad_s;
  const double reach_m = reach_of(*object.tree, motion.centre_object);
  const bool is_tree_still = is_still(tree_motion);
  double accelerates_m_s2 = 0.0;
  if (!is_tree_still) {
    // In the tree's frame, a point accelerates by the Coriolis and centrifugal terms of the tree's rotation.
    // Those of a common rotation about the object's centre cancel.
    const Vec3& tree_rad_s = tree_motion.angular_rad_s;
    const Vec3 between = centre_world - tree.T_world_mesh * tree_motion.centre_object;
    const Vec3 apart_m_s = motion.linear_m_s - tree_motion.linear_m_s;
    linear_world = apart_m_s - tree_rad_s.cross(between);
    angular_world -= tree_rad_s;
    accelerates_m_s2 =
        2.0 * tree_rad_s.norm() * angular_world.norm() * reach_m +
        (tree_rad_s.cross(tree_rad_s.cross(between)) - 2.0 * tree_rad_s.cross(apart_m_s)).norm() +
        tree_rad_s.squaredNorm() * apart_m_s.norm() * duration_s;
  }
  const Eigen::Matrix3d R_frame_world = trees.T_world_frame.linear().transpose();
  const Vec3 angular = R_frame_world * angular_world;
  const double turn_rad_s = angular.norm();
  const Vec3 squares = angular.cwiseAbs2();
  const Vec3 turning_m_s =
      reach_m *
      Vec3(squares.y() + squares.z(), squares.z() + squares.x(), squares.x() + squares.y()).cwiseSqrt();
  RelativeMotion relative{R_frame_world * linear_world,
                          angular,
                          trees.T_world_frame.inverse() * centre_world,
                          turn_rad_s,
                          reach_m,
                          keep_m,
                          0.5 * accelerates_m_s2,
                          !is_tree_still,
                          0.5 * turn_rad_s * turning_m_s,
                          turning_m_s,
                          linear_world.norm() + turn_rad_s * reach_m + accelerates_m_s2 * duration_s};
  relative.quadratic_m_s2.array() += 0.5 * accelerates_m_s2;
  return relative;
}

/// Free time against one tree of the scene, from its pairs of triangles.
struct TreeFreedom {
  TreePair& trees;
  const SurfaceKind kind;
  const std::uint32_t number;  // index among the scene's trees
  const RelativeMotion course;
  FreeTime result;

  /// Returns the free time of two boxes; infinite if it exceeds the least found so far.
  [[nodiscard]] float key(const PairBox& o, const PairBox& s) const {
    constexpr float kLongEnough = kInfinity<float>;
    const float free_s = course.free_s(o, s, result.free_s);
    if (free_s == kLongEnough) return kLongEnough;
    if (are_large_against(o, s)) {
      const Vec3 centre = s.centre.cast<double>(), half = s.half.cast<double>();
      for (const FrameTriangle& t : trees.of_object(o)) {
        const Vec3 direction = t.normal.dot(t.corners[0] - centre) >= 0.0 ? t.normal : Vec3(-t.normal);
        const double face_at = direction.dot(centre) + direction.cwiseAbs().dot(half);
        if (!course.separates_for(result.free_s, direction, t, face_at)) return free_s;
      }
      return kLongEnough;
    }
    if (are_large_against(s, o)) {
      for (const FrameTriangle& t : trees.of_scene(s)) {
        const bool is_free = course.separates_for(result.free_s, t, o);
        if (!is_free && !(is_one_sided(kind) && is_behind(t, o))) return free_s;
      }
      return kLongEnough;
    }
    return free_s;
  }

  /// Finds the best of the planes between two triangles.
  void look(const FrameTriangle& o, const FrameTriangle& s) {
    const auto is_long_enough = [&](const Vec3& direction) {
      return course.separates_for(result.free_s, direction, o, range_along(direction, s.corners).high);
    };
    const double side_of_scene = s.normal.dot(o.corners[0] - s.corners[0]) >= 0.0 ? 1.0 : -1.0;
    if (is_one_sided(kind) && range_along(s.normal, o.corners).high < s.normal.dot(s.corners[0])) return;
    const double side_of_object = o.normal.dot(s.corners[0] - o.corners[0]) >= 0.0 ? -1.0 : 1.0;
    const std::array<Vec3, 2> normals = {side_of_scene * s.normal, side_of_object * o.normal};
    if (is_long_enough(normals[0]) || is_long_enough(normals[1])) return;
    const auto [from, way] = shortest_way(o, s, 0.0);
    const double distance_m = way.norm();
    if (distance_m > 0.0 && is_long_enough(-way / distance_m)) return;
    double free_s = std::max(course.free_s(normals[0], o, s), course.free_s(normals[1], o, s));
    if (distance_m > 0.0) free_s = std::max(free_s, course.free_s(-way / distance_m, o, s));
    if (free_s >= 0.0 && distance_m > 0.0)
      free_s = std::max(free_s, course.free_s_turning(-way / distance_m, o, s, result.free_s));
    if (free_s >= result.free_s) return;
    if (free_s < 0.0) {
      if (!(distance_m > 0.0) || cross(face_of(o), face_of(s))) return;
      free_s = 0.0;  // rounding hides the plane in so small a gap
    }
    if (!(distance_m > 0.0)) return;  // they touch: the contacts determine how they separate
    if (is_one_sided(kind) && !is_outside(-way / distance_m, s)) return;
    result.free_s = free_s;
    result.limit = {trees.T_world_frame * (from + way), trees.T_world_frame.linear() * (-way / distance_m),
                    distance_m, kind, number};
  }

  void look_at_leaves(const PairBox& o, const PairBox& s) {
    for (const FrameTriangle& object : trees.of_object(o))
      for (const FrameTriangle& scene : trees.of_scene(s)) look(object, scene);
  }
};

/// Replaces the point of the scene by the one nearest to the object's point. Beside the edge of a triangle, a
/// neighbour may be nearer: the direction across the edge is then none of the surface's normals.
void move_to_nearest(ClosestPoint& limit, const SceneTree& tree) {
  constexpr double kRounding = 1.0 - 1e-9;
  const Vec3 on_object = limit.point_world + limit.gap_m * limit.normal_world;
  const std::optional<Vec3> nearest = nearest_point(tree.instance, on_object, kRounding * limit.gap_m);
  if (!nearest) return;
  const Vec3 way = on_object - *nearest;
  if (!(way.norm() > 0.0)) return;
  limit.point_world = *nearest;
  limit.gap_m = way.norm();
  limit.normal_world = way / limit.gap_m;
}

}  // namespace

FreeTime free_time(const MovingTree& moving_object, double duration_s, double keep_m, const RadarScene& scene,
                   SurfaceKindMask left_out, const TreeStates& trees) {
  const auto& [object, motion] = moving_object;
  thread_local PendingPairs pending;  // scratch
  FreeTime result;
  if (!is_usable(object) || !(duration_s > 0.0)) return result;
  result.free_s = duration_s;
  // No point travels farther than its path. Pairs farther apart than twice keep_m may approach to keep_m.
  const double object_path_m = path_m(object, motion, duration_s);
  for (std::uint32_t number = 0; number < scene.trees.size(); ++number) {
    if (trees.is_left_out(number)) continue;  // first: another thread may be moving it
    const SceneTree& tree = scene.trees[number];
    if (!is_usable(tree.instance) || (left_out & bit_of(tree.kind)) != 0) continue;
    const RigidMotion tree_motion = number < trees.motions.size() ? trees.motions[number] : RigidMotion{};
    const double paths_m = object_path_m + path_m(tree.instance, tree_motion, duration_s);
    if (are_farther_apart(object, tree.instance, paths_m + 2.0 * keep_m)) continue;
    TreePair pair(object, tree.instance);
    TreeFreedom freedom{
        pair, tree.kind, number,
        relative_motion(moving_object, {tree.instance, tree_motion}, duration_s, keep_m, pair), result};
    visit_pairs<PairOrder::kLeastFirst>(
        pair, pending, [&](const PairBox& o, const PairBox& s) { return freedom.key(o, s); },
        [&](const PairBox& o, const PairBox& s) {
          freedom.look_at_leaves(o, s);
          return static_cast<float>(freedom.result.free_s);
        });
    result = freedom.result;
  }
  if (result.limit.kind != SurfaceKind::kNothing && !is_one_sided(result.limit.kind))
    move_to_nearest(result.limit, scene.trees[result.limit.tree]);
  return result;
}

}  // namespace roomradar
