// object_overlap.hpp: detects overlaps of objects with others and with the room, and resolves them.
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

/// Lifts an object that overlaps other objects onto them. Leaves it in place if the room is in the way.
/// @param room      everything that the object can touch except objects
/// @param margin_m  gap kept to the objects below, m; smaller overlaps are ignored
void raise_over_others(VirtualObject& object, std::span<const std::unique_ptr<VirtualObject>> objects,
                       std::span<const SceneTree> room, double margin_m, CyberRadar& radar,
                       ProximityQuery& proximity);

/// Thrown if an object cannot be placed because surfaces are in the way.
class PlaceRefused : public Error {
  using Error::Error;
};

/// Surroundings of an object, and the queries for moving it out of surfaces that intersect it.
struct WayOut {
  const SessionRoom& room;
  std::vector<SceneTree> surfaces;  ///< everything that the object can touch except other objects
  std::vector<SceneTree> all;       ///< the same, with other objects
  double gap_m;                     ///< gap to surfaces after the move, m
  CyberRadar& radar;
  ProximityQuery& proximity;
};

/// Moves an object to the nearest free pose within 10 cm if a surface of the room intersects it, or its
/// centre is in solid unknown space. Throws PlaceRefused if a surface intersects it and there is no such
/// pose; the message names the nearest free place found within 1 m.
/// @return the end of a sentence for the user; empty if the object has moved by less than 5 mm
std::string leave_surfaces(VirtualObject& object, const WayOut& way);

/// Measures the time for which an object has been awake and has moved by less than 2 mm. Returns true when
/// this time reaches 1 s, and restarts it.
bool is_still_too_long(VirtualObject& object, double waited_s);

/// If a surface that does not move (static, or another object's) intersects the object, moves the object to
/// the nearest free pose within 10 cm, or else marks it as stuck.
/// @return the end of a sentence for the user; empty if no surface intersects it, or it was stuck before
std::string free_or_stuck(VirtualObject& object, const WayOut& way);

/// Returns the depth by which a surface of the scene overlaps the object along a direction, m, >= 0. A
/// surface in a hollow of the object, such as in a cup's handle, does not count if it does not intersect the
/// object.
double penetration_m(const VirtualObject& object, std::span<const SceneTree> scene,
                     const Eigen::Vector3d& direction_world, CyberRadar& radar, ProximityQuery& proximity);

}  // namespace roomradar
