// unknown_support.hpp: objects that rest on the border of unknown space, and from where to scan what is
// there.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>

#include "app/objects/virtual_object.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// Returns true if the object is asleep and something that it rests on is the border of unknown space.
bool rests_on_unknown(const VirtualObject& object);

/// Returns the middle of the object's lowest level, where it rests, in the world.
Eigen::Vector3d support_point_world(const VirtualObject& object);

/// Returns a position 0.6 to 1.5 m from the object's support point with a free line of sight to it, from
/// which a person can scan what is under the object; the steepest that is free, nearest to `towards_world` on
/// its circle. nullopt if all lines of sight are blocked.
/// @param scene  surfaces that block the view: the room's, and the border of unknown space
std::optional<Eigen::Vector3d> viewpoint_of_support(const VirtualObject& object,
                                                    std::span<const SceneTree> scene,
                                                    const Eigen::Vector3d& towards_world);

/// Returns the rest of a sentence about the object: where it rests, and from where to look.
std::string unknown_support_text(const VirtualObject& object, std::span<const SceneTree> scene,
                                 const Eigen::Vector3d& towards_world);

}  // namespace roomradar
