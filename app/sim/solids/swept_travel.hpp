// swept_travel.hpp: exact distance to contact of an object made of solids that moves in a straight line.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "app/sim/solids/solid.hpp"

namespace roomradar {

struct SweptTravel {
  double contact_distance_m = 0.0;  ///< distance to the first contact; the limit if there is none
  bool touches = false;
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();   ///< contact point on the obstacle
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, from the obstacle towards the object
};

/// Advances each part against each obstacle by conservative advancement, until they touch or separate for
/// good. The error is below 1e-7 m, never too far.
/// @param parts            of the object, in its own frame; they may overlap
/// @param direction_world  unit
/// Source: Mirtich, PhD thesis, Berkeley 1996, section 2.3.
SweptTravel swept_travel(std::span<const Solid> obstacles, std::span<const Solid> parts,
                         const Eigen::Isometry3d& T_world_object, const Eigen::Vector3d& direction_world,
                         double limit_m);

}  // namespace roomradar
