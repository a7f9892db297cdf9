// solid_distance.hpp: exact distance between convex solids.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "app/sim/solids/solid.hpp"

namespace roomradar {

/// Distance between two solids a and b, with direction and nearest point.
struct Separation {
  /// Distance between the surfaces, m; 0 if the solids touch or overlap.
  double distance_m = 0.0;
  /// Unit vector from b towards a. Zero if the solids overlap even without their inflation (Solid::round_m).
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();
  /// Point of b's surface nearest to a.
  Eigen::Vector3d point_b_world = Eigen::Vector3d::Zero();
};

/// Computes the distance between a and b. The result is at most 1e-9 m too small and never too large. Source:
/// Gilbert, Johnson, Keerthi, IEEE Journal of Robotics and Automation 1988.
Separation separation(const Solid& a, const Solid& b);

/// Returns the distance between an object, made of `parts` at T_world_object, and the nearest of `obstacles`.
/// Returns enough_m if the distance is larger.
double clearance_m(std::span<const Solid> obstacles, std::span<const Solid> parts,
                   const Eigen::Isometry3d& T_world_object, double enough_m);

/// Returns the solid's axis-aligned bounding box in the world frame.
Eigen::AlignedBox3d bounds_world(const Solid& solid);

}  // namespace roomradar
