// departure.hpp: returns an object that fell out of the map to its last resting pose.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace roomradar {

struct VirtualObject;

/// An object that fell out of the map.
struct Departure {
  std::string name;
  /// Position of its origin when the fall was detected, m.
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();
  bool is_back = false;  ///< true: returned to its last resting pose; false: removed from the room
};

/// Checks whether an object has fallen out of the map, that is, whether its whole bounding sphere is more
/// than 0.5 m below lowest_known_m. Returns such an object to the pose in which it last slept, and puts it to
/// sleep. Removes the object from the room if it has not slept since it was added or last returned. Ignores
/// carried objects. Call once per frame, after physics.
/// @param lowest_known_m  world z (m) of the lowest point of the map's surface and observed space
/// @return unset: the object has not fallen out of the map
std::optional<Departure> end_departure(VirtualObject& object, double lowest_known_m);

}  // namespace roomradar
