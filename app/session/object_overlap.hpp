// object_overlap.hpp: overlaps of objects with others and with the room, and ways out of them.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/session/session_room.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar {

/// Lifts an object that overlaps other objects until it is on top of them. Leaves it in place if the room is
/// in the way.
/// @param room      everything that the object can touch, without objects
/// @param margin_m  gap kept to the objects below, m; smaller overlaps are ignored
void raise_over_others(VirtualObject& object, std::span<const std::unique_ptr<VirtualObject>> objects,
                       std::span<const SceneTree> room, double margin_m, CyberRadar& radar,
                       ProximityQuery& proximity);

/// An object cannot be placed since surfaces are in the way.
class PlaceRefused : public Error {
  using Error::Error;
};

/// Surroundings of an object, and queries, for its way out of surfaces that cross it.
struct WayOut {
  const SessionRoom& room;
  std::vector<SceneTree> surfaces;  ///< everything that the object can touch, without other objects
  std::vector<SceneTree> all;       ///< the same, with other objects
  double gap_m;                     ///< gap kept to surfaces after the way out, m
  CyberRadar& radar;
  ProximityQuery& proximity;
};

/// Moves an object that a surface of the room crosses, or whose middle is in solid unknown space, to the
/// nearest free pose within 10 cm. Throws PlaceRefused, with the nearest free place found within 1 m, if a
/// surface crosses it and there is no such pose.
/// @return the end of a sentence for the user; empty if the object has moved by less than 5 mm
std::string leave_surfaces(VirtualObject& object, const WayOut& way);

/// Advances the time for which an object has been awake without moving by 2 mm. Returns true when the time
/// reaches 1 s, then begins again.
bool is_still_too_long(VirtualObject& object, double waited_s);

/// If a lasting surface crosses the object, moves it out as leave_surfaces(), or marks it as stuck.
/// @return the end of a sentence for the user; empty if nothing crosses it, or it was stuck before
std::string free_or_stuck(VirtualObject& object, const WayOut& way);

/// Returns the depth by which a surface of the scene overlaps the object along a direction, m, >= 0. A
/// surface that crosses no part of the object, since it is in a hollow such as a handle, does not count.
double penetration_m(const VirtualObject& object, std::span<const SceneTree> scene,
                     const Eigen::Vector3d& direction_world, CyberRadar& radar, ProximityQuery& proximity);

}  // namespace roomradar
