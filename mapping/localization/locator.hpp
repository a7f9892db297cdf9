// locator.hpp: localises the camera in a saved map, frame by frame.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/motion_prior.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/localization/correlative_search.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/patch_matching.hpp"
#include "mapping/localization/pose_hypothesis.hpp"
#include "mapping/localization/relocalise.hpp"

namespace roomradar {

/// Callback that renders the depth of the room's static model at a pose, in the size of the live depth image.
/// The returned image is valid until the next call of the callback.
using ExpectedDepth = std::function<const DepthImage&(const Eigen::Isometry3d& T_world_camera)>;

/// Search indices over the keyframe database. Each is built when it is first used.
struct MapIndices {
  PatchIndex patches;
  ShapeIndex shapes;  ///< surfaces in the keyframes' downsampled depth images
};

/// Buffers that are reused for each frame.
struct LocatorBuffers {
  ViewPyramid live_pyramid, expected_pyramid;
  SourcePoints live;
  TargetView expected;
  Image<float> grey;
};

/// Settings of locate(), and its state between frames.
struct Locator {
  /// Resolution of the live view. Twice the resolution costs 3 ms more and does not improve accuracy.
  ViewConfig live_view{.finest_width_px = 160};
  /// Resolution of the expected view (rendered by ExpectedDepth). Rendered depth needs no smoothing.
  ViewConfig expected_view{.finest_width_px = 160, .noisy = false};
  AlignConfig align;
  /// Alignment settings with a higher min_constraint. Bumps of the mesh then do not count as constraining a
  /// direction. Used for poses that depth alone must constrain. Also used to repeat an alignment after which
  /// more than a third of the matching patches no longer match.
  AlignConfig strict_align{.min_constraint = 0.01F};
  RelocaliseConfig relocalise;
  int verify_every_n_frames = 1;  ///< frames between two comparisons of measured with expected depth
  std::optional<Eigen::Isometry3d> T_world_camera;  ///< pose of the previous frame; unset while lost
  /// Predicted motion from the previous frame to the next.
  Eigen::Isometry3d T_last_now = Eigen::Isometry3d::Identity();
  /// Use recorded poses of the frames as a prior on the motion, see MotionPrior.
  bool use_recorded_poses = false;
  MotionPrior prior;
  std::optional<double> last_stamp_s;
  Tracking last_tracking;   ///< result of the previous frame
  Image<float> moved_grey;  ///< intensity image of the last frame before which the camera moved
  int stood_frames = 0;     ///< consecutive frames whose images show that the camera stands
  /// Time for which unconstrained directions were only predicted, s.
  double carried_s = 0.0;
  /// True after carried_s has exceeded 0.15 s or the position's standard deviation 5 cm, until a pose is
  /// verified.
  bool is_uncertain = false;
  int uncertain_frames = 0;   ///< consecutive frames with is_uncertain
  int followed_frames = 0;    ///< number of frames followed so far
  int unverified_frames = 0;  ///< number of consecutive frames whose depth contradicts the tracked pose
  /// Number of further frames whose depth must contradict the pose before the next search of the map.
  int recheck_cooldown_frames = 0;
  /// Last pose before tracking was lost. locate() tries this pose in the first 30 frames after the loss.
  std::optional<Eigen::Isometry3d> T_world_lost;
  int lost_frames = 0;

  std::vector<PoseHypothesis> hypotheses;  ///< all pose hypotheses of the last search
  SearchEnd search_end = SearchEnd::kNoCandidate;

  MapIndices index;
  LocatorBuffers buffers;
};

/// Localises a frame. First aligns the frame with the depth expected at the pose predicted from the last
/// motion. Searches the map if the alignment fails, if the depth has contradicted the pose for three frames,
/// or if no pose is known.
///
/// The search matches surface patches of the frame with the map's (patch_matching.hpp). If patches give no
/// certain pose and gravity is known, the search uses the shape of the depth (correlative_search.hpp). If
/// gravity is unknown and the frame has no colour or the map no patches, the search uses relocalise(). A pose
/// found by search must be certain (is_certain()) and unambiguous (is_ambiguous()).
///
/// If the status is kDegenerate, the pose equals the prediction in unconstrained directions. After 0.15 s of
/// such poses, or a standard deviation of 5 cm, the status is kUncertain: the pose is the best guess, and the
/// map is searched until patches or depth verify a pose. If two images show that the camera stands
/// (is_camera_stationary()), and depth does not contradict it, the pose stays as it is. A sensor that
/// recalibrates distorts its depth for a moment. If alignment mistakes the distortion for motion, locate()
/// returns the previous frame's pose with kDegenerate.
///
/// @param dynamic_mask  empty, or of the depth image's size. Non-zero pixels showed a moving object in the
///                      previous frame and are ignored
/// @return a usable pose if the status is kTracked or kDegenerate, a best guess if it is kUncertain. With any
///         other status, the camera is lost, and the next call searches the map
Tracking locate(Locator& locator, const Frame& frame, const KeyframeDatabase& keyframe_database,
                const MaskImage& dynamic_mask, const ExpectedDepth& expected_depth);

}  // namespace roomradar
