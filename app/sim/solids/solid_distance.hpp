// solid_distance.hpp: how far apart two convex solids are, exactly.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "app/sim/solids/solid.hpp"

namespace roomradar {

/// A plane between two solids, as good as there is one.
struct Separation {
  double distance_m = 0.0;  ///< between the surfaces; 0 if the solids touch or overlap
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();   ///< unit, from b towards a; zero if cores overlap
  Eigen::Vector3d point_b_world = Eigen::Vector3d::Zero();  ///< of b's surface, nearest to a
};

/// Distance of a from b to 1e-9 m, never more than it is.
/// Source: Gilbert, Johnson, Keerthi, IEEE Journal of Robotics and Automation 1988.
Separation separation(const Solid& a, const Solid& b);

/// Least distance of any of `parts`, moved by T_world_object, from any of `obstacles`; at most `enough_m`.
double clearance_m(std::span<const Solid> obstacles, std::span<const Solid> parts,
                   const Eigen::Isometry3d& T_world_object, double enough_m);

/// The smallest box along the world's axes that holds the solid.
Eigen::AlignedBox3d bounds_world(const Solid& solid);

}  // namespace roomradar
