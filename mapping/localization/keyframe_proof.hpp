// keyframe_proof.hpp: geometric verification of a frame's pose relative to a keyframe, by the depth of both;
// comparison of the depth of two keyframes.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <span>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/place_matching.hpp"

namespace roomradar {

/// Builds the pyramid of a keyframe's preview: its downsampled depth image, without intensity.
void make_preview_pyramid(const MapKeyframe& keyframe, const ViewConfig& view, ViewPyramid& pyramid);

/// Converts a preview to a target of align(), with the identity as its pose.
TargetView target_of(const ViewPyramid& preview, const ViewConfig& view);

struct KeyframeProof {
  bool holds = false;
  Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
  double agreement = 0.0;  ///< fraction of the common pixels whose depths agree
  double overlap = 0.0;    ///< fraction of the frame's points that the keyframe sees, too
  TargetView target;       ///< the keyframe's preview, with the identity as its pose; for joint_pose()
};

/// Refines the pose of a feature match by alignment with the keyframe's depth. KeyframeProof::holds requires
/// an aligned pose (has_pose()), an overlap above 0.2, agreement of the depths, and a pose within 12 cm and
/// 0.12 rad of the feature match's pose.
KeyframeProof prove_with_features(const SourcePoints& live, const MapKeyframe& keyframe,
                                  const KeyframeMatch& match, double min_depth_agreement,
                                  const ViewConfig& view);

/// A keyframe that verifies the frame's pose.
struct KeyframeWitness {
  std::size_t keyframe = 0;  ///< index in the database
  int feature_inliers = 0;
  KeyframeProof proof;
};
/// Returns the frame's pose in the world frame, according to one witness.
Eigen::Isometry3d pose_by(const KeyframeWitness& witness, const KeyframeDatabase& keyframe_database);

/// Returns the witness with the most inliers, then the highest agreement. `witnesses` must not be empty.
const KeyframeWitness& best_of(std::span<const KeyframeWitness> witnesses);

/// Returns the frame's pose in the world frame, aligned jointly with all witnesses that agree with the best
/// one. This averages the errors of the keyframes' poses.
Eigen::Isometry3d joint_pose(std::span<const KeyframeWitness> witnesses, const KeyframeWitness& best,
                             const SourcePoints& live, const KeyframeDatabase& keyframe_database);

/// Pixel counts of one preview (a keyframe's downsampled depth image) compared with another, over every
/// fourth pixel of every fourth row.
struct PreviewOverlap {
  int valid = 0;    ///< number of pixels with depth of at most 4 m
  int same = 0;     ///< number of valid pixels on the other preview's surface
  int through = 0;  ///< number of valid pixels in front of that surface: the other camera saw through them
};

/// Compares the depth of a keyframe with that of another.
/// @param T_to_from    relative pose of the two cameras
/// @param tolerance_m  max assumed error of T_to_from, added to the noise of the depth
PreviewOverlap compare_previews(const MapKeyframe& from, const MapKeyframe& to,
                                const Eigen::Isometry3d& T_to_from, double tolerance_m);

}  // namespace roomradar
