// swept_travel.hpp: distance to contact of an object made of solids that moves in a straight line.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "app/sim/solids/solid.hpp"

namespace roomradar {

struct SweptTravel {
  /// Distance to the first contact; limit_m if there is none.
  double contact_distance_m = 0.0;
  /// True if there is a contact within limit_m.
  bool touches = false;
  /// Contact point on the obstacle, m.
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  /// Unit normal from the obstacle towards the object.
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();
};

/// Moves each part towards each obstacle by conservative advancement until they touch or can no longer touch.
/// The result is less than 1e-7 m too small and never too large. Source: Mirtich, PhD thesis, Berkeley 1996,
/// section 2.3.
/// @param parts            solids of the object, in its own frame. They may overlap
/// @param T_world_object   start pose
/// @param direction_world  unit direction of motion
/// @param limit_m          max distance
SweptTravel swept_travel(std::span<const Solid> obstacles, std::span<const Solid> parts,
                         const Eigen::Isometry3d& T_world_object, const Eigen::Vector3d& direction_world,
                         double limit_m);

}  // namespace roomradar
