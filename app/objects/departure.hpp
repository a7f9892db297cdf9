// departure.hpp: sets back an object that fell out of the map.
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
  bool is_back = false;  ///< true: back where it last rested; false: it has not rested, and left the room
};

/// Sets an object that is half a metre below everything known back to where it last rested, asleep. Takes it
/// out of the room if it has not rested, or if nothing supports it there any more. Carried objects stay. Call
/// once per frame, after physics.
/// @param lowest_known_m  least height in the world that the map knows
/// @return unset: the object has not departed
std::optional<Departure> end_departure(VirtualObject& object, double lowest_known_m);

}  // namespace roomradar
