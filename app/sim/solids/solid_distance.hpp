// solid_distance.hpp: exact distance between convex solids.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "app/sim/solids/solid.hpp"

namespace roomradar {

/// Distance, direction and nearest point between two solids a and b.
struct Separation {
  double distance_m = 0.0;  ///< between the surfaces; 0 if the solids touch or overlap
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();   ///< unit, from b towards a; zero if cores overlap
  Eigen::Vector3d point_b_world = Eigen::Vector3d::Zero();  ///< point of b's surface nearest to a
};

/// Computes the distance between a and b to 1e-9 m, never too large. Source: Gilbert, Johnson, Keerthi, IEEE
/// Journal of Robotics and Automation 1988.
Separation separation(const Solid& a, const Solid& b);

/// Returns the least distance between `parts`, moved by T_world_object, and `obstacles`; at most `enough_m`.
double clearance_m(std::span<const Solid> obstacles, std::span<const Solid> parts,
                   const Eigen::Isometry3d& T_world_object, double enough_m);

/// Returns the solid's axis-aligned bounding box in the world.
Eigen::AlignedBox3d bounds_world(const Solid& solid);

}  // namespace roomradar
