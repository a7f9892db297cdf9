// keyframe_graph.hpp: pose graph of keyframes, with relative poses from alignment as edges.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/keyframe.hpp"
#include "mapping/alignment/keyframe_cache.hpp"
#include "mapping/odometry/pose_graph.hpp"

namespace roomradar {

struct KeyframeGraphConfig {
  int max_edges_rebuild = 12;  ///< max number of edges from a keyframe to older ones in close_loops()
  int max_edges_new = 6;       ///< max number of edges from a new keyframe to older ones while tracking
  double furthest = 1.5;       ///< max view_distance() of keyframes connected without place recognition
  double min_overlap = 0.25;   ///< min fraction of a keyframe's points with a correspondence
  double min_inliers = 0.5;    ///< min fraction of a pair's correspondences that are inliers
  /// Max difference between the two results of aligning a pair in both directions.
  double max_gap_m = 0.05;
  double max_gap_rad = 0.05;
  /// Max assumed drift between two keyframes: of the translation, drift_m plus drift_part times the length of
  /// the path between them; of the rotation, drift_rad plus drift_rad_per_m times that length. An edge that
  /// would change the relative pose by more is rejected as perceptual aliasing (a false match between similar
  /// parts of the room).
  double drift_m = 0.15;
  double drift_part = 0.05;
  double drift_rad = 0.15;
  double drift_rad_per_m = 0.05;
  std::size_t cached_keyframes = 8;  ///< capacity of the keyframe cache; 4 MB per keyframe
};

struct KeyframeGraph {
  std::vector<Keyframe> keyframes;  ///< the first pose is constant if there are no anchors
  std::vector<PoseConstraint> constraints;
  /// Standard deviation of recorded poses (MotionPrior::sigma_m), which connect consecutive keyframes.
  double recorded_sigma_m = 0.0;
  /// Measured poses of keyframes in the world frame of a known map. Some may be wrong: see
  /// agreeing_anchors().
  std::vector<PoseAnchor> anchors;
  /// Number of connected pairs that are at least three keyframes apart in sequence.
  std::int64_t loops_found = 0;
  std::int64_t loops_rejected = 0;
};

/// Settings for preparing, aligning and connecting keyframes.
struct ConnectConfig {
  ViewConfig view;
  AlignConfig align;
  KeyframeGraphConfig graph;
};

/// Returns true if a keyframe, moved by T_known_world, is within 0.15 m and 0.1 rad of the anchor.
bool agrees(const PoseAnchor& anchor, const Keyframe& keyframe, const Eigen::Isometry3d& T_known_world);

/// Returns the anchors that agree with the keyframes' present poses. Only these constrain the poses: a view
/// of moved furniture alone is recognised where the furniture stood.
std::vector<PoseAnchor> agreeing_anchors(const KeyframeGraph& graph);

/// Returns the indices of all keyframes of a part whose view_distance() to a camera pose is less than
/// `furthest`, nearest first.
std::vector<std::size_t> keyframes_near(std::span<const Keyframe> keyframes,
                                        const Eigen::Isometry3d& T_world_camera, double furthest,
                                        int part = 0);

/// Returns true if T_older_newer differs from the two keyframes' current relative pose by less than the
/// assumed drift (KeyframeGraphConfig::drift_m and the following).
bool is_within_drift(const KeyframeGraph& graph, std::size_t older, std::size_t newer,
                     const Eigen::Isometry3d& T_older_newer, const KeyframeGraphConfig& config);

/// Two keyframes, aligned with each other in both directions.
struct KeyframePair {
  std::size_t older = 0;
  std::size_t newer = 0;
  Tracking newer_in_older;  ///< its pose is T_older_newer
  Tracking older_in_newer;  ///< its pose is T_newer_older
};

/// Adds both alignments of a pair as constraints if they agree with each other and are within the assumed
/// drift of the current poses. Returns true if they were added. A pair that is at least three keyframes apart
/// in sequence is counted as a loop, in loops_found or loops_rejected.
bool add_constraints(KeyframeGraph& graph, const KeyframePair& pair, const KeyframeGraphConfig& config);

/// Aligns two keyframes, starting from T_older_newer, and adds their constraints as add_constraints() does.
/// Caches `newer`; uses `older` from the cache if it is there.
bool join(KeyframeGraph& graph, std::size_t older, std::size_t newer, const Eigen::Isometry3d& T_older_newer,
          const ConnectConfig& config, KeyframeCache& cache);

/// Connects the newest keyframe to older keyframes near it. If more than max_edges_new keyframes are near,
/// chooses max_edges_new of them, spread evenly over the order of view_distance().
void connect_newest(KeyframeGraph& graph, const ConnectConfig& config, KeyframeCache& cache);

/// Connects a keyframe with the one before it by their present relative pose, if corners constrained the pose
/// of one of them: alignments of the two then constrain only some directions.
void connect_flow(KeyframeGraph& graph, std::size_t keyframe);

/// Connects a keyframe with the one before it by their recorded relative pose, if both have recorded poses of
/// the same stretch.
void connect_recorded(KeyframeGraph& graph, std::size_t keyframe);

/// Optimises all keyframe poses to fit the constraints and anchors.
void solve(KeyframeGraph& graph);

/// Computes the final poses of all keyframes in two steps, to reduce the effect of the sensor's depth
/// distortion. Distortion is constant in the camera frame. Unlike noise, distortion does not average out over
/// many points. Distortion cancels between similar views. Between different views, distortion biases the
/// relative pose, mostly by a rotation about the observed surface. Alignment wrongly reports this rotation as
/// well constrained.
///
/// The first step therefore computes the positions. That step weights constraints by the similarity of their
/// views (view_distance()), and uses the constraints' information matrices only to exclude unconstrained
/// directions. The second step keeps the positions and computes the rotations, with constraints weighted by
/// their information.
void solve_positions_then_turns(KeyframeGraph& graph);

/// Optimises only the keyframes whose view_distance() to the newest is less than `furthest`; all other poses
/// are constant.
void solve_near_newest(KeyframeGraph& graph, double furthest);

}  // namespace roomradar
