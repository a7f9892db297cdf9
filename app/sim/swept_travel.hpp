// swept_travel.hpp: how far a solid can move straight on before it touches a room, exactly.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "app/sim/room.hpp"

namespace roomradar {

/// Points of a solid's core, grown by whose round_m they cover its surface where it looks along
/// `direction_solid`. Faces and edges are sampled at spacing_m, corners exactly. A ball's core is its one
/// middle point.
std::vector<Eigen::Vector3d> leading_core_points(const Solid& solid, const Eigen::Vector3d& direction_solid,
                                                 double spacing_m);

struct SweptTravel {
  double travel_m = 0.0;  ///< to the first contact; the limit if there is none before it
  bool touches = false;
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();  ///< of the object, where it touches
};

/// Sphere tracing of every leading point through the room's exact distance. Exact for balls; for others it
/// may be too long where an edge meets an edge between two points, by less than spacing_m.
/// @param direction_world  unit
SweptTravel swept_travel(const Room& room, const Solid& object, const Eigen::Isometry3d& T_world_object,
                         const Eigen::Vector3d& direction_world, double limit_m, double spacing_m = 0.004);

}  // namespace roomradar
