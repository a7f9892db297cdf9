// free_pose.hpp: search for the shortest translation that moves an object out of surfaces that intersect it.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <span>

#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar {

/// Returns true if a surface intersects the object's surface. One-sided surfaces (inferred backs and the
/// frontier of unknown space, see is_one_sided()) never count.
bool is_crossed(const TreeInstance& object, std::span<const SceneTree> surfaces);

struct FreePose {
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  double moved_m = 0.0;  ///< length of the translation
};

/// Returns the pose after the shortest translation, among 98 directions, that leaves the object free of all
/// surfaces. The object ends on the front side of the surface that intersected it. For example, an object in
/// a floor ends above it, not below. During the translation, the object may pass through other surfaces.
/// @param gap_m       min distance between object and surfaces after the translation, > 0
/// @param max_m       max length of the translation, > 0. Lengths are sampled in steps of max_m / 20, then
///                    refined by bisection
/// @param is_allowed  returns false for poses to reject, such as poses in unknown space. Null accepts all
///                    poses
/// @return unset if no such translation is found
/// Takes 1 to 400 ms: too slow for a call in each frame.
std::optional<FreePose> nearest_free_pose(const TreeInstance& object, std::span<const SceneTree> surfaces,
                                          double gap_m, double max_m,
                                          const std::function<bool(const Eigen::Isometry3d&)>& is_allowed,
                                          CyberRadar& radar);

}  // namespace roomradar
