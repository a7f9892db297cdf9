// keyframe_graph.hpp: pose graph of keyframes and the measured motions between them.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/keyframe.hpp"
#include "mapping/alignment/keyframe_cache.hpp"
#include "mapping/odometry/pose_graph.hpp"

namespace roomradar {

struct KeyframeGraphConfig {
  int max_edges_rebuild = 12;  ///< max edges from a keyframe to older ones on a full rebuild
  int max_edges_new = 6;       ///< max edges from a new keyframe to older ones during tracking
  double furthest = 1.5;       ///< max view_distance() of two connected keyframes
  double min_overlap = 0.25;   ///< min fraction of a keyframe's points with a correspondence in the other
  double min_inliers = 0.5;    ///< min fraction of these correspondences that agree
  double max_gap_m = 0.05;     ///< max difference between the alignments in both directions
  double max_gap_rad = 0.05;
  /// Max pose correction (m and rad) by a loop closure: drift_m plus drift_part of the path between the two
  /// keyframes. Places that only look alike are farther apart.
  double drift_m = 0.15;
  double drift_part = 0.05;
  std::size_t prepare_keyframe = 8;  ///< keyframes in the cache, 4 MB each
};

struct KeyframeGraph {
  std::vector<Keyframe> keyframes;  ///< the first pose is constant, unless there are anchors
  std::vector<PoseConstraint> constraints;
  std::vector<PoseAnchor> anchors;  ///< poses of keyframes in a known map
  std::int64_t loops_found = 0;     ///< connected pairs that are not neighbours in sequence
  std::int64_t loops_rejected = 0;
};

/// Settings for preparing and aligning keyframes.
struct ConnectConfig {
  ViewConfig view;
  AlignConfig align;
  KeyframeGraphConfig graph;
};

/// Returns how much two viewpoints differ. At 1, such as 0.8 m or 35 degrees apart, the views hardly overlap.
double view_distance(const Eigen::Isometry3d& T_a_b);

/// Returns the indices of the keyframes with view_distance() below `furthest`, nearest first.
std::vector<std::size_t> keyframes_near(const KeyframeGraph& graph, const Eigen::Isometry3d& T_world_camera,
                                        double furthest);

/// Returns whether T_older_newer differs from the current poses by no more than the assumed drift.
bool is_within_drift(const KeyframeGraph& graph, std::size_t older, std::size_t newer,
                     const Eigen::Isometry3d& T_older_newer, const KeyframeGraphConfig& config);

/// Aligns two keyframes both ways, starting from T_older_newer. If the results agree with each other, and
/// with the current poses within drift, adds both as constraints and returns true. Pairs that are not
/// neighbours in sequence count as loops, found or rejected.
bool join(KeyframeGraph& graph, std::size_t older, std::size_t newer, const Eigen::Isometry3d& T_older_newer,
          const ConnectConfig& config, KeyframeCache& prepare_keyframe);

/// Connects the newest keyframe to older ones near it; if there are too many, to a selection over all
/// distances.
void connect_newest(KeyframeGraph& graph, const ConnectConfig& config, KeyframeCache& prepare_keyframe);

/// Rebuilds all constraints from the keyframes' current depth, on two threads; deterministic.
void close_loops(KeyframeGraph& graph, const ConnectConfig& config);

/// Optimises all keyframe poses to fit the constraints and anchors.
void solve(KeyframeGraph& graph);

/// Computes the final poses of all keyframes in two steps. Over the many points that two keyframes share,
/// noise averages out, but distortion of the depth, constant in the camera frame, remains. Distortion cancels
/// between similar views. Between different views it bends the relative motion, mostly into a rotation about
/// the observed surface, and alignment reports this rotation as well constrained. So the first step finds the
/// positions: it weights constraints by the similarity of their views (view_distance()), and uses their
/// information only to exclude unconstrained directions. The second step finds the rotations that best fit
/// these positions, weighted by information.
void solve_positions_then_turns(KeyframeGraph& graph);

/// Same as solve(), but moves only keyframes with view_distance() to the newest below `furthest`.
void solve_near_newest(KeyframeGraph& graph, double furthest);

}  // namespace roomradar
