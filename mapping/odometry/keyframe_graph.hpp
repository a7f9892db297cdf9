// keyframe_graph.hpp: keyframes, measured motions between them, and the poses that fit all.
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
  int joins = 12;             ///< at most, of a keyframe with older ones, when all are joined anew
  int joins_at_once = 6;      ///< of a new keyframe with older ones, while tracking goes on
  double furthest = 1.5;      ///< view_distance() past which two keyframes are not joined
  double min_overlap = 0.25;  ///< of a keyframe's points, those that must meet the other
  double min_inliers = 0.5;   ///< and of those, the part that must agree
  double max_gap_m = 0.05;    ///< between the motion there and the motion back
  double max_gap_rad = 0.05;
  /// How wrong the poses may be between two keyframes, from which a loop closure that says more is refused:
  /// this, and a part of the way between them. Two places that look alike are further apart.
  double drift_m = 0.15;
  double drift_part = 0.05;
  std::size_t warm = 8;  ///< keyframes of which everything is at hand, 4 MB each
};

struct KeyframeGraph {
  std::vector<Keyframe> keyframes;  ///< the first one's pose is held, unless there are anchors
  std::vector<PoseConstraint> constraints;
  std::vector<PoseAnchor> anchors;  ///< where keyframes stand in a map that is known already
  std::int64_t loops_found = 0;     ///< pairs of keyframes, not neighbours in number, that are joined
  std::int64_t loops_rejected = 0;
};

/// What views are made and aligned with.
struct JoinConfig {
  ViewConfig view;
  AlignConfig align;
  KeyframeGraphConfig graph;
};

/// How differently two cameras look: 1 where they stand 0.8 m or 35 degrees apart, and hardly see the same
/// any more.
double view_distance(const Eigen::Isometry3d& T_a_b);

/// Positions of the keyframes with view_distance() below `furthest`, nearest first.
std::vector<std::size_t> keyframes_near(const KeyframeGraph& graph, const Eigen::Isometry3d& T_world_camera,
                                        double furthest);

/// Whether the poses may be that wrong: T_older_newer against what they say now.
bool is_within_drift(const KeyframeGraph& graph, std::size_t older, std::size_t newer,
                     const Eigen::Isometry3d& T_older_newer, const KeyframeGraphConfig& config);

/// Aligns two keyframes both ways, starting from T_older_newer. If both agree with each other, and with what
/// the poses can be wrong by, the graph gets both as constraints. Returns whether it did. Keyframes that are
/// not neighbours in number are counted as loops, found or rejected.
bool join(KeyframeGraph& graph, std::size_t older, std::size_t newer, const Eigen::Isometry3d& T_older_newer,
          const JoinConfig& config, WarmKeyframes& warm);

/// Joins the newest keyframe with older ones near it, few of many being spread over all distances.
void join_newest(KeyframeGraph& graph, const JoinConfig& config, WarmKeyframes& warm);

/// Forgets all constraints and joins all keyframes anew, with the depth that they have by now, on two
/// threads; the answer does not depend on them.
void join_all(KeyframeGraph& graph, const JoinConfig& config);

/// Moves all keyframes to where the constraints and anchors want them.
void solve(KeyframeGraph& graph);

/// Moves all keyframes to where the constraints and anchors want them for good, in two steps. Averaged over
/// as many points as two keyframes share, noise is nothing; what is left is the depth's own distortion, fixed
/// to the camera. It cancels where two keyframes look alike, and bends the motion between them the more they
/// differ, mostly into a turn about what is seen, which to the alignment looks well measured. So positions
/// come first, with constraints that weigh by how alike their keyframes look (view_distance()) and not by
/// their information, but for directions that have none; then the turns that fit these positions best, by
/// information.
void solve_positions_then_turns(KeyframeGraph& graph);

/// The same as solve(), but only those that look about where the newest looks are moved.
void solve_near_newest(KeyframeGraph& graph, double furthest);

}  // namespace roomradar
