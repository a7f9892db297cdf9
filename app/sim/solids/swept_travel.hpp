// swept_travel.hpp: how far an object made of solids can move straight on before it touches others, exactly.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "app/sim/solids/solid.hpp"

namespace roomradar {

struct SweptTravel {
  double travel_m = 0.0;  ///< to the first contact; the limit if there is none before it
  bool touches = false;
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();   ///< of the obstacle, where it is touched
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, from there towards the object
};

/// Each part of the object against each obstacle: as far as the plane between them allows, again and again,
/// until they touch or the plane is left behind. Error under 1e-7 m, never too far.
/// @param parts            of the object, in its own frame; they may overlap
/// @param direction_world  unit
/// Source: conservative advancement, Mirtich, PhD thesis, Berkeley 1996, section 2.3.
SweptTravel swept_travel(std::span<const Solid> obstacles, std::span<const Solid> parts,
                         const Eigen::Isometry3d& T_world_object, const Eigen::Vector3d& direction_world,
                         double limit_m);

}  // namespace roomradar
