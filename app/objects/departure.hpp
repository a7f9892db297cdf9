// departure.hpp: puts an object that fell out of the map back.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "app/objects/virtual_object.hpp"

namespace roomradar {

/// An object that fell out of the map.
struct Departure {
  std::string name;
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();  ///< position of its origin when noticed, m
  bool is_back = false;  ///< true: put back where it last rested; false: removed from the room
};

/// Puts an object that is half a metre below lowest_known_m back where it last rested, asleep. Removes it
/// from the room if it has not rested so far, or if it has fallen out from that position before. Carried
/// objects are left alone. Call once per frame, after physics.
/// @param lowest_known_m  least height of the map's surface and observed space, in the world
/// @return unset: the object has not departed
std::optional<Departure> end_departure(VirtualObject& object, double lowest_known_m);

}  // namespace roomradar
