// free_pose.hpp: moves an object out of surfaces that intersect it, by the shortest translation found.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <span>

#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar {

/// Returns true if a surface intersects the object's surface. One-sided surfaces (is_one_sided()) never
/// count.
bool is_crossed(const TreeInstance& object, std::span<const SceneTree> surfaces, ProximityQuery& proximity);

struct FreePose {
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  double moved_m = 0.0;  ///< length of the translation
};

/// Finds the shortest translation, among 26 directions, after which no surface intersects the object. The
/// object ends on the front of a surface that it left: an object in a floor rises and does not fall through.
/// On the way, the object may pass through other surfaces.
/// @param gap_m       min distance from all surfaces after the translation, > 0
/// @param max_m       max length of the translation, > 0; lengths are sampled in steps of max_m / 20, then
///                    bisected
/// @param is_allowed  returns false for poses that must not be chosen, such as in unknown space; null: all
///                    are allowed
/// @return unset if no such translation is found
/// Takes 1 to 100 ms: call it for an event, not in each frame.
std::optional<FreePose> nearest_free_pose(const TreeInstance& object, std::span<const SceneTree> surfaces,
                                          double gap_m, double max_m,
                                          const std::function<bool(const Eigen::Isometry3d&)>& is_allowed,
                                          CyberRadar& radar, ProximityQuery& proximity);

}  // namespace roomradar
