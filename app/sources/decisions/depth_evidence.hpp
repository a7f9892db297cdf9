// depth_evidence.hpp: whether unit, cameras and poses of a recording agree with its depth.
#pragma once
#include <optional>

#include "app/sources/decisions/decide.hpp"

namespace roomradar {

/// How well the depth of one frame predicts that of another one.
struct DepthDifference {
  /// Mean over the compared points of min(difference / (2 % of depth), 1). Correct poses give 0.3 to 0.65,
  /// because edges, noise and time offsets differ; wrong ones give 0.8 and more.
  double disagreement = 1.0;
  double median_m = 0.0;  ///< median absolute difference
};

/// Compares points of `from`, moved by T_to_from, with the depth image `to`, in both directions. Both images
/// are of `camera`. A pair that overlaps by less than a fifth has the disagreement 1.
DepthDifference depth_difference(const DepthImage& from, const DepthImage& to, const Intrinsics& camera,
                                 const Eigen::Isometry3d& T_to_from);

/// Compares the depth of nearby frames, in a dozen places of the recording, with each other. Fills
/// DecidedRecording::evidence, and reports what cannot be right:
/// - poses under which depth does not agree. If it agrees under another convention (inverse, OpenGL's axes,
///   w x y z, mm, cm, one frame early or late), that one is used, else the poses are not used at all. A
///   convention that the user has stated is kept
/// - a unit of depth that a full image's median depth, the sensor's range or the poses contradict
/// - a focal length under which depth agrees much less than under one 10 to 40 % longer or shorter
/// @param is_convention_given  the user has stated the convention of the poses
void question_depth(DecidedRecording& recording, bool is_convention_given);

}  // namespace roomradar
