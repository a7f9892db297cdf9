// anchors.hpp: local coordinate frames (anchors) of the live model's parts, which follow corrections of
// keyframe poses.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/odometry/odometry_snapshot.hpp"

namespace roomradar {

/// Coordinate frame of a part of the live model (LiveModel), fixed relative to a keyframe. At its creation,
/// an anchor's axes are parallel to the world frame's, and its origin is the camera position. When a loop
/// closure corrects the keyframe's pose, the anchor's world pose changes accordingly.
struct Anchor {
  std::optional<std::size_t> keyframe;  ///< unset: T_keyframe_anchor is the constant pose in the world frame
  Eigen::Isometry3d T_keyframe_anchor = Eigen::Isometry3d::Identity();
  /// Camera pose at the anchor's creation. Frames with similar camera poses belong to the anchor, see
  /// anchor_for().
  Eigen::Isometry3d T_anchor_camera = Eigen::Isometry3d::Identity();
  std::int64_t last_frame = 0;  ///< index of the last frame that belongs to the anchor
};

/// Current poses of anchors; unset: the anchor was removed.
using AnchorPoses = std::vector<std::optional<Eigen::Isometry3d>>;

/// Anchors, and their current poses.
struct Anchors {
  std::vector<Anchor> anchors;
  AnchorPoses T_world_anchor;
};

/// Recomputes T_world_anchor from the current poses of the anchors' keyframes. Removes anchors whose keyframe
/// no longer exists. Returns true if an anchor was removed, moved by more than 1 cm or rotated by more than 5
/// mrad.
bool correct(const OdometrySnapshot& odometry, Anchors& anchors);

/// Returns the index of the anchor whose camera pose (T_anchor_camera) is nearest to T_world_camera, and adds
/// the frame to the anchor. Adds an anchor if no anchor's camera pose is within 0.8 m and 40 degrees.
std::size_t anchor_for(std::int64_t frame_index, const Eigen::Isometry3d& T_world_camera,
                       const OdometrySnapshot& odometry, Anchors& anchors);

/// Removes each anchor whose last frame has this index or a later one.
void forget_frames_from(std::int64_t frame_index, Anchors& anchors);

}  // namespace roomradar
