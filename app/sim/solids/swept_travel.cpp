// swept_travel.cpp: conservative advancement of convex parts among convex obstacles.
#include "app/sim/solids/swept_travel.hpp"

#include <algorithm>

#include "app/sim/solids/solid_distance.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

/// Advances one part until it touches one obstacle; returns false if it does not within `limit_m`.
bool advance(Solid part, const Solid& obstacle, const Vector3d& direction_world, double limit_m,
             SweptTravel& result) {
  constexpr double kTouching_m = 1e-8;
  constexpr int kSteps = 200;  // flat against flat takes two; grazing a rounded end takes some dozens
  const Vector3d start_world = part.T_world_solid.translation();
  double contact_distance_m = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    part.T_world_solid.translation() = start_world + contact_distance_m * direction_world;
    const Separation apart = separation(part, obstacle);
    const double approach = -apart.normal_world.dot(direction_world);
    if (apart.distance_m <= kTouching_m) {
      if (apart.normal_world.isZero(0.0)) {  // overlapping at the start
        result = {contact_distance_m, true, part.T_world_solid.translation(), -direction_world};
      } else {
        result = {contact_distance_m, true, apart.point_b_world, apart.normal_world};
      }
      return true;
    }
    if (approach <= 0.0) return false;
    // Stops just short of the plane, since a distance of 0 has no direction.
    contact_distance_m += (apart.distance_m - 0.5 * kTouching_m) / approach;
    if (contact_distance_m >= limit_m) return false;
  }
  return false;  // grazes with less than kTouching_m per step
}

}  // namespace

SweptTravel swept_travel(std::span<const Solid> obstacles, std::span<const Solid> parts,
                         const Eigen::Isometry3d& T_world_object, const Vector3d& direction_world,
                         double limit_m) {
  SweptTravel result;
  result.contact_distance_m = limit_m;
  for (Solid part : parts) {
    part.T_world_solid = T_world_object * part.T_world_solid;
    const Eigen::AlignedBox3d bounds = bounds_world(part);
    for (const Solid& obstacle : obstacles) {
      Eigen::AlignedBox3d swept = bounds;
      swept.extend(bounds.translated(result.contact_distance_m * direction_world));
      if (swept.intersects(bounds_world(obstacle)))
        advance(part, obstacle, direction_world, result.contact_distance_m, result);
    }
  }
  return result;
}

}  // namespace roomradar
