// anchors.hpp: local coordinate frames (anchors) of a live model's parts, corrected with the keyframes'
// poses.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/odometry/odometry_snapshot.hpp"

namespace roomradar {

/// Coordinate frame of a part of the live model. At its creation, an anchor's axes are parallel to the world
/// frame's, and its origin is the camera position. When loop closures correct the poses, the anchor moves
/// with its keyframe.
struct Anchor {
  std::optional<std::size_t> keyframe;  ///< unset: T_keyframe_anchor is the constant pose in the world frame
  Eigen::Isometry3d T_keyframe_anchor = Eigen::Isometry3d::Identity();
  /// Camera pose at the anchor's creation. Frames with similar camera poses belong to the anchor.
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

/// Sets the anchors' poses to those of their keyframes. Anchors of keyframes that no longer exist are
/// removed. Returns true if one is removed, or if a point 2 m from an anchor moved by more than 1 cm.
bool correct(const OdometrySnapshot& odometry, Anchors& anchors);

/// Returns the index of the anchor with the view most similar to the camera's. Adds an anchor if no anchor's
/// view is within 0.8 m and 40 degrees.
std::size_t anchor_for(std::int64_t frame_index, const Eigen::Isometry3d& T_world_camera,
                       const OdometrySnapshot& odometry, Anchors& anchors);

/// Removes the anchors of frames from this index on.
void forget_frames_from(std::int64_t frame_index, Anchors& anchors);

}  // namespace roomradar
