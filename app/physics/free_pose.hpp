// free_pose.hpp: moves an object out of surfaces that cross it, by the shortest translation found.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <span>

#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar {

/// Returns true if a surface crosses the object. One-sided surfaces (is_one_sided()) never count.
bool is_crossed(const TreeInstance& object, std::span<const SceneTree> surfaces, ProximityQuery& proximity);

struct FreePose {
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  double moved_m = 0.0;  ///< length of the translation
};

/// Translates an object until no surface crosses it, in the direction of 26 that needs the shortest way. Each
/// way leads through the front of a surface: an object in a floor rises and does not fall through. The way
/// may cross other surfaces.
/// @param gap_m       kept to all surfaces, > 0
/// @param max_m       max length of the way, > 0; the ways are sampled in steps of max_m / 20, then bisected
/// @param is_allowed  returns false for poses that must not be chosen, such as in unknown space; null: all
/// allowed
/// @return unset if no way ends free
/// Takes 1 to 100 ms: call it for an event, not in each frame.
std::optional<FreePose> nearest_free_pose(const TreeInstance& object, std::span<const SceneTree> surfaces,
                                          double gap_m, double max_m,
                                          const std::function<bool(const Eigen::Isometry3d&)>& is_allowed,
                                          CyberRadar& radar, ProximityQuery& proximity);

}  // namespace roomradar
