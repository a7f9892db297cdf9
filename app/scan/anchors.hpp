// anchors.hpp: coordinate frames of the parts of a live model, which move with the keyframes.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "mapping/odometry/odometry_snapshot.hpp"

namespace roomradar {

/// Coordinate frame of a part of the live model. Its axes were the world's when it was made, and its origin
/// was the camera. It moves with a keyframe when closed loops correct the poses.
struct Anchor {
  std::optional<std::size_t> keyframe;  ///< unset: T_keyframe_anchor is the pose in the world, and constant
  Eigen::Isometry3d T_keyframe_anchor = Eigen::Isometry3d::Identity();
  /// View that the anchor was made for; decides which frames belong to it.
  Eigen::Isometry3d T_anchor_camera = Eigen::Isometry3d::Identity();
};

/// Anchors, and their current poses.
struct Anchors {
  std::vector<Anchor> anchors;
  std::vector<Eigen::Isometry3d> T_world_anchor;
};

/// Sets the anchors' poses to those of their keyframes. Returns true if a point 2 m from an anchor moved by
/// more than 1 cm.
bool correct(const OdometrySnapshot& odometry, Anchors& anchors);

/// Returns the anchor with the view most similar to the camera's, or makes a new anchor if none was made
/// within 0.8 m and 40 degrees.
std::size_t anchor_for(const Eigen::Isometry3d& T_world_camera, const OdometrySnapshot& odometry,
                       Anchors& anchors);

}  // namespace roomradar
