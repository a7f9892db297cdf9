// object_overlap.hpp: measures overlaps of objects, and separates a placed object from others.
#pragma once
#include <memory>
#include <span>

#include "app/objects/virtual_object.hpp"
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

/// Returns the depth by which a surface of the scene overlaps the object along a direction, m, >= 0. A
/// surface that crosses no part of the object, since it is in a hollow such as a handle, does not count.
double penetration_m(const VirtualObject& object, std::span<const SceneTree> scene,
                     const Eigen::Vector3d& direction_world, CyberRadar& radar, ProximityQuery& proximity);

}  // namespace roomradar
