// object_light.hpp: how much light the room's surfaces leave for an object.
#pragma once
#include <Eigen/Geometry>

#include "app/render/room_light.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// Fractions, 0 to 1, of the light that arrives at an object.
struct LightReach {
  float directed = 1.0F;
  float ambient = 1.0F;
};

/// Casts rays at the room's surfaces: seven towards the main light, from points of the object's inscribed
/// disk that faces it, up to 3 m, and 16 upwards, cosine weighted, up to 1 m. Nearer surfaces take more of
/// the ambient light. Both fractions are 1 without surfaces, and for values that are not finite.
/// @param room            the room's surfaces; may be null or empty
/// @param middle_world    centre of the object
/// @param radius_m        radius of its bounding sphere
/// @param to_light_world  unit
LightReach light_reach(const TreeInstance& room, const Eigen::Vector3d& middle_world, double radius_m,
                       const Eigen::Vector3d& to_light_world);

}  // namespace roomradar
