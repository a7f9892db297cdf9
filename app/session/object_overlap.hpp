// object_overlap.hpp: detects and resolves overlaps of objects with each other and with the room.
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

/// Raises an object that overlaps other objects until it stands on them. Leaves its pose unchanged if a
/// surface of the room would be in the way.
/// @param room      all surfaces that the object can touch, except other objects
/// @param margin_m  gap to the objects below after the move, m. Smaller overlaps are ignored
void raise_over_others(VirtualObject& object, std::span<const std::unique_ptr<VirtualObject>> objects,
                       std::span<const SceneTree> room, double margin_m, CyberRadar& radar);

/// Thrown if an object cannot be placed because a surface intersects it.
class PlaceRefused : public Error {
  using Error::Error;
};

/// Arguments of the functions that move an object out of surfaces that intersect it.
struct WayOut {
  const SessionRoom& room;
  std::vector<SceneTree> surfaces;  ///< all surfaces that the object can touch, except other objects
  std::vector<SceneTree> all;       ///< `surfaces` and the other objects
  double gap_m;                     ///< gap between object and surfaces after the move, m
  CyberRadar& radar;
};

/// Moves an object to the nearest free pose within 10 cm. Does nothing unless a surface intersects the object
/// or a part of it is in solid unknown space. Other objects do not count as surfaces. Throws PlaceRefused if
/// no free pose is within 10 cm. A thrown object that no surface intersects is not refused: it may begin in
/// unknown space. The error message names the nearest free position found within 1 m, if any.
/// @return notice text without the object's name. Empty if the object was moved by less than 5 mm
std::string leave_surfaces(VirtualObject& object, const WayOut& way, bool is_thrown);

/// Adds waited_s to Placement::still_s, the time for which the object has been awake, not carried, and
/// has moved by at most 2 mm. Returns true when still_s reaches 1 s, and resets still_s to 0.
bool is_still_too_long(VirtualObject& object, double waited_s);

/// Moves the object to the nearest free pose within 10 cm if a surface or another object intersects it.
/// Dynamic surfaces do not count. Sets Placement::stuck if there is no such pose.
/// @return notice text without the object's name; empty if no surface intersects the object, or if it was
///         stuck already
std::string free_or_stuck(VirtualObject& object, const WayOut& way);

/// Returns the penetration depth of the scene's surfaces into the object along a direction, m, >= 0. A
/// surface that only passes through a concavity of the object, such as a cup's handle, does not count.
double penetration_m(const VirtualObject& object, std::span<const SceneTree> scene,
                     const Eigen::Vector3d& direction_world, CyberRadar& radar);

}  // namespace roomradar
