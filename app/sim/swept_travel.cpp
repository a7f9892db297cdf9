// swept_travel.cpp: leading points of boxes, cylinders and grown cores on their way through the room.
#include "app/sim/swept_travel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomradar {
namespace {

using Eigen::Vector3d;

/// A face that the motion does not press forward cannot be the first to touch.
constexpr double kForward = 1e-9;

void add_box_points(const Vector3d& half_m, const Vector3d& direction, double spacing_m, bool all,
                    std::vector<Vector3d>& points) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      if (!all && side * direction[axis] < kForward) continue;
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      const int columns = std::max(1, static_cast<int>(std::ceil(2.0 * half_m[next] / spacing_m)));
      const int rows = std::max(1, static_cast<int>(std::ceil(2.0 * half_m[last] / spacing_m)));
      for (int i = 0; i <= (half_m[next] > 0.0 ? columns : 0); ++i)
        for (int j = 0; j <= (half_m[last] > 0.0 ? rows : 0); ++j) {
          Vector3d p;
          p[axis] = side * half_m[axis];
          p[next] = half_m[next] * (2.0 * i / columns - 1.0);
          p[last] = half_m[last] * (2.0 * j / rows - 1.0);
          points.push_back(p);
        }
    }
}

void add_cylinder_points(const Vector3d& half_m, const Vector3d& direction, double spacing_m, bool all,
                         std::vector<Vector3d>& points) {
  const double radius_m = half_m.x(), end_m = half_m.z();
  const int around = std::max(8, static_cast<int>(std::ceil(2.0 * std::numbers::pi * radius_m / spacing_m)));
  const int along = std::max(1, static_cast<int>(std::ceil(2.0 * end_m / spacing_m)));
  const int rings = std::max(1, static_cast<int>(std::ceil(radius_m / spacing_m)));
  for (int i = 0; i < around; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / around;
    const Vector3d outward(std::cos(angle), std::sin(angle), 0.0);
    if (all || outward.dot(direction) >= kForward)
      for (int j = 0; j <= along; ++j)
        points.push_back(radius_m * outward + Vector3d(0, 0, end_m * (2.0 * j / along - 1.0)));
    for (const double side : {-1.0, 1.0})
      if (all || side * direction.z() >= kForward)
        for (int ring = 1; ring <= rings; ++ring)
          points.push_back(radius_m * ring / rings * outward + Vector3d(0, 0, side * end_m));
  }
}

/// Gradient of the room's distance: away from the nearest surface.
Vector3d outward(const Room& room, const Vector3d& p_world) {
  constexpr double kStep_m = 1e-6;
  Vector3d gradient;
  for (int axis = 0; axis < 3; ++axis)
    gradient[axis] = signed_distance_m(room, p_world + kStep_m * Vector3d::Unit(axis)) -
                     signed_distance_m(room, p_world - kStep_m * Vector3d::Unit(axis));
  return gradient.normalized();
}

}  // namespace

std::vector<Vector3d> leading_core_points(const Solid& solid, const Vector3d& direction_solid,
                                          double spacing_m) {
  std::vector<Vector3d> points;
  if (solid.half_m.isZero(0.0)) {
    points.push_back(Vector3d::Zero());
    return points;
  }
  const bool all = solid.round_m > 0.0;  // a grown core leads with its edges too
  if (solid.shape == SolidShape::kBox) {
    add_box_points(solid.half_m, direction_solid, spacing_m, all, points);
  } else {
    add_cylinder_points(solid.half_m, direction_solid, spacing_m, all, points);
  }
  return points;
}

SweptTravel swept_travel(const Room& room, const Solid& object, const Eigen::Isometry3d& T_world_object,
                         const Vector3d& direction_world, double limit_m, double spacing_m) {
  constexpr double kTouching_m = 1e-7;
  constexpr double kLeastStep_m = 1e-6;  // sliding along a surface must come to an end
  SweptTravel result;
  result.travel_m = limit_m;
  const Eigen::Isometry3d T_world_solid = T_world_object * object.T_world_solid;
  for (const Vector3d& p_solid :
       leading_core_points(object, T_world_solid.linear().transpose() * direction_world, spacing_m)) {
    const Vector3d start_world = T_world_solid * p_solid;
    for (double travel_m = 0.0; travel_m < result.travel_m;) {
      const Vector3d p_world = start_world + travel_m * direction_world;
      const double clear_m = signed_distance_m(room, p_world) - object.round_m;
      if (clear_m < kTouching_m) {
        result = {travel_m, true, p_world - object.round_m * outward(room, p_world)};
        break;
      }
      travel_m += std::max(clear_m, kLeastStep_m);
    }
  }
  return result;
}

}  // namespace roomradar
