// unknown_support.hpp: words for an object's support, and viewpoints for scanning supports in unknown space.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "app/objects/virtual_object.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// Returns words for the support of a resting object, such as " on the room's surface"; empty for kNothing.
std::string_view support_words(SurfaceKind kind);

/// Returns true if the object is asleep on the frontier, the boundary between observed free space and
/// unobserved space.
bool rests_on_unknown(const VirtualObject& object);

/// Returns the world point below the centre of the object's bounding box, at the height of its lowest vertex.
Eigen::Vector3d support_point_world(const VirtualObject& object);

/// Returns a viewpoint for scanning the surface under the object. The viewpoint is 0.6, 1 or 1.5 m from
/// support_point_world(), with a free line of sight to it. Among free viewpoints, the highest elevation angle
/// (60, 45, 30 or 15 degrees) is preferred. Ties are broken by the largest distance, then by the azimuth
/// nearest to that of `towards_world`. Returns nullopt if all lines of sight are blocked.
/// @param scene  surfaces. Only the static room and the frontier block lines of sight
std::optional<Eigen::Vector3d> viewpoint_of_support(const VirtualObject& object,
                                                    std::span<const SceneTree> scene,
                                                    const Eigen::Vector3d& towards_world);

/// A surface to scan, and a free position from which it can be seen.
struct PlaceToScan {
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d viewpoint_world = Eigen::Vector3d::Zero();
};

/// Returns a sentence, without the object's name, that states the support point and the viewpoint for
/// scanning it.
std::string unknown_support_text(const VirtualObject& object, std::span<const SceneTree> scene,
                                 const Eigen::Vector3d& towards_world);

}  // namespace roomradar
