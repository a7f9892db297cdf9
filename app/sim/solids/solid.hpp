// solid.hpp: convex solids of rooms and moving objects, with exact distances and ray casts.
#pragma once
#include <Eigen/Geometry>

namespace roomradar {

enum class SolidShape {
  /// Box: half_m has its half sizes along x, y and z of the solid's frame.
  kBox,
  /// Cylinder about z: radius half_m.x() (= half_m.y()), half height half_m.z().
  kCylinder,
};

/// A box or cylinder, inflated by round_m (Minkowski sum with a ball). An inflated point is a sphere, an
/// inflated line segment a capsule.
struct Solid {
  SolidShape shape = SolidShape::kBox;
  Eigen::Isometry3d T_world_solid = Eigen::Isometry3d::Identity();
  /// Half extents before inflation, m.
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();
  /// Radius of the ball.
  double round_m = 0.0;
};

Solid box(const Eigen::Vector3d& centre_world, const Eigen::Vector3d& size_m, double yaw_rad = 0.0);
Solid rounded_box(const Eigen::Vector3d& centre_world, const Eigen::Vector3d& size_m, double round_m,
                  double yaw_rad = 0.0);
/// Returns an upright cylinder whose base is centred at foot_world.
Solid cylinder(const Eigen::Vector3d& foot_world, double radius_m, double height_m);
Solid sphere(const Eigen::Vector3d& centre_world, double radius_m);
Solid capsule(const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world, double radius_m);

/// Returns the exact distance (m) from a point in the solid's frame to the solid's surface, negative inside.
double signed_distance_local_m(const Solid& solid, const Eigen::Vector3d& p_solid);
/// Returns the exact distance (m) from a point in the world frame to the solid's surface, negative inside.
double signed_distance_m(const Solid& solid, const Eigen::Vector3d& p_world);

/// Returns the unit outward normal, in the solid's frame, of the surface point nearest to p_solid.
Eigen::Vector3d normal_local(const Solid& solid, const Eigen::Vector3d& p_solid);

/// Returns the smallest t > 0 at which the ray origin_solid + t * direction_solid enters the solid from
/// outside. Returns a negative number if the ray misses the solid or starts inside. The direction may have
/// any length > 0.
double ray_entry_local(const Solid& solid, const Eigen::Vector3d& origin_solid,
                       const Eigen::Vector3d& direction_solid);

/// Returns the half extents of the solid's bounding box in its own frame.
inline Eigen::Vector3d bounds_half_m(const Solid& solid) {
  return solid.half_m + Eigen::Vector3d::Constant(solid.round_m);
}

}  // namespace roomradar
