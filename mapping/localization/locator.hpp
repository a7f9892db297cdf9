// locator.hpp: localises the camera in a saved map, frame by frame.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/localization/correlative_search.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/patch_matching.hpp"
#include "mapping/localization/pose_hypothesis.hpp"
#include "mapping/localization/relocalise.hpp"

namespace roomradar {

/// Callback that renders the depth of the room's static model at a pose, in the size of the live depth image.
/// The returned image is valid until the next call.
using ExpectedDepth = std::function<const DepthImage&(const Eigen::Isometry3d& T_world_camera)>;

/// Search indices over the keyframe database. Each is built when it is first used.
struct MapIndices {
  PatchIndex patches;
  ShapeIndex shapes;  ///< surfaces in the keyframes' downsampled depth images
};

/// Buffers that are reused for each frame: pyramid and points of the live image, pyramid and planes of the
/// expected depth.
struct LocatorBuffers {
  ViewPyramid live_pyramid, expected_pyramid;
  SourcePoints live;
  TargetView expected;
};

/// Settings of locate(), and its state between frames.
struct Locator {
  /// Resolution of the live view. Twice the resolution costs 3 ms more and does not improve accuracy.
  ViewConfig live_view{.finest_width_px = 160};
  /// Resolution of the expected view. Rendered depth needs no smoothing.
  ViewConfig expected_view{.finest_width_px = 160, .noisy = false};
  AlignConfig align;
  /// Alignment settings for poses that depth alone must constrain, and for a second alignment if the first
  /// loses most of the matching patches. With the higher min_constraint, bumps of the mesh do not count as
  /// constraining a direction.
  AlignConfig strict_align{.min_constraint = 0.01F};
  RelocaliseConfig relocalise;
  std::optional<Eigen::Isometry3d> T_world_camera;  ///< pose of the previous frame; unset while lost
  /// Predicted motion from the previous frame to the next.
  Eigen::Isometry3d T_last_now = Eigen::Isometry3d::Identity();
  int unverified_frames = 0;  ///< number of consecutive frames whose depth contradicts the tracked pose
  /// Remaining number of frames with contradicting depth before the map may be searched again.
  int recheck_cooldown_frames = 0;
  /// Last pose before tracking was lost; locate() tries to resume there in the first 30 lost frames.
  std::optional<Eigen::Isometry3d> T_world_lost;
  int lost_frames = 0;

  std::vector<PoseHypothesis> hypotheses;  ///< all pose hypotheses of the last search
  SearchEnd search_end = SearchEnd::kNoCandidate;

  MapIndices index;
  LocatorBuffers buffers;
};

/// Localises a frame. First aligns it with the depth expected at the pose predicted from the last motion.
/// Searches the map if this fails, if the depth has contradicted the pose for three frames, or if no pose is
/// known.
///
/// The search uses the map's patches; if they give no certain pose and gravity is known, it uses the shape of
/// the depth. Without gravity, and without colour or patches in the map, it uses relocalise(). A pose found
/// by search must be constrained in all directions, verified by depth and patches, and unambiguous.
///
/// With kDegenerate, the pose equals the prediction in unconstrained directions. A sensor that recalibrates
/// distorts its depth for a moment; if alignment mistakes this for motion, the whole pose is the previous
/// frame's, with kDegenerate.
///
/// @param dynamic_mask  not 0: the pixel showed a moving object in the previous frame and is ignored; empty,
///                      or of the depth image's size
/// @return a usable pose if the status is kTracked or kDegenerate; with any other status, the camera is
///         lost, and the next call searches for it
Tracking locate(Locator& locator, const Frame& frame, const KeyframeDatabase& keyframe_database,
                const MaskImage& dynamic_mask, const ExpectedDepth& expected_depth);

}  // namespace roomradar
