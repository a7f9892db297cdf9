// locator.hpp: localises the camera in the saved room, frame by frame.
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

/// Renders the depth of the room's static model at a pose, in the size of the live depth image.
using ExpectedDepth = std::function<const DepthImage&(const Eigen::Isometry3d& T_world_camera)>;

/// Indices over the keyframe database, each built on first use.
struct MapIndices {
  PatchIndex patches;
  ShapeIndex shapes;  ///< surfaces of the keyframes
};

/// Buffers reused from frame to frame: the live image, and the depth expected at a pose.
struct LocatorBuffers {
  ViewPyramid live_pyramid, expected_pyramid;
  SourcePoints live;
  TargetView expected;
};

/// Settings, and state kept from frame to frame.
struct Locator {
  ViewConfig live_view{.finest_width_px = 160};  ///< twice the resolution costs 3 ms and gains no accuracy
  ViewConfig expected_view{.finest_width_px = 160, .noisy = false};  ///< rendered depth needs no smoothing
  AlignConfig align;
  /// For poses that depth alone must constrain, and for aligned poses that patches contradict. The higher
  /// min_constraint keeps bumps of a mesh from passing for constraints.
  AlignConfig strict_align{.min_constraint = 0.01F};
  RelocaliseConfig relocalise;
  std::optional<Eigen::Isometry3d> T_world_camera;  ///< pose of the last frame; unset while lost
  /// Predicted motion from the last frame to the next.
  Eigen::Isometry3d T_last_now = Eigen::Isometry3d::Identity();
  int unverified_frames = 0;        ///< number of consecutive frames whose depth contradicts the tracked pose
  int recheck_cooldown_frames = 0;  ///< doubtful frames left before the map is searched again
  /// Last pose before tracking was lost; tried for the first 30 of lost_frames.
  std::optional<Eigen::Isometry3d> T_world_lost;
  int lost_frames = 0;

  std::vector<PoseHypothesis> hypotheses;  ///< pose hypotheses of the last search
  SearchEnd search_end = SearchEnd::kNoCandidate;

  MapIndices index;
  LocatorBuffers buffers;
};

/// Localises the frame by alignment with the expected depth at the pose predicted from the last motion.
/// Searches the map if this fails, if the depth has contradicted the pose for three frames, or if no pose is
/// known. The search uses the map's patches, then the shape of the depth if gravity is known. If there is
/// neither colour nor gravity, it uses the keyframe database. A pose found by search must be constrained in
/// all directions, verified by depth and patches, and unambiguous.
///
/// With kDegenerate, unconstrained directions are the prediction's; or the whole pose is the last frame's,
/// because alignment took a bend of the sensor's depth for a motion.
///
/// @param dynamic_mask  not 0: pixel moved in the previous frame, is ignored; empty, or of the depth's size
/// @return status kTracked or kDegenerate: a usable pose; other status: not localised, searched for next time
Tracking locate(Locator& locator, const Frame& frame, const KeyframeDatabase& keyframe_database,
                const MaskImage& dynamic_mask, const ExpectedDepth& expected_depth);

}  // namespace roomradar
