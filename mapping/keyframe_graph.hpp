// keyframe_graph.hpp: keyframes, measured motions between them, and the poses that fit all.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/align.hpp"
#include "mapping/keyframe.hpp"
#include "mapping/pose_graph.hpp"

namespace roomradar {

struct KeyframeGraphConfig {
  int joins = 12;             ///< at most, of a keyframe with older ones, when all are joined anew
  int joins_at_once = 6;      ///< of a new keyframe with older ones, while tracking goes on
  double furthest = 1.5;      ///< view_distance() past which two keyframes are not joined
  double min_overlap = 0.25;  ///< of a keyframe's points, those that must meet the other
  double min_inliers = 0.5;   ///< and of those, the part that must agree
  double max_gap_m = 0.05;    ///< between the motion there and the motion back
  double max_gap_rad = 0.05;
};

struct KeyframeGraph {
  std::vector<Keyframe> keyframes;  ///< the first one's pose is held
  std::vector<PoseConstraint> constraints;
  std::int64_t loops_found = 0;
  std::int64_t loops_rejected = 0;
};

/// How differently two cameras look: 1 where they stand 0.8 m or 35 degrees apart, and hardly see the same
/// any more.
double view_distance(const Eigen::Isometry3d& T_a_b);

/// Positions of the keyframes with view_distance() below `furthest`, nearest first.
std::vector<std::size_t> keyframes_near(const KeyframeGraph& graph, const Eigen::Isometry3d& T_world_camera,
                                        double furthest);

/// Aligns two keyframes both ways, starting from T_older_newer. If both agree, the graph gets both as
/// constraints. Returns whether it did. Keyframes that are not neighbours in number are counted as loops,
/// found or rejected.
bool join(KeyframeGraph& graph, std::size_t older, std::size_t newer, const Eigen::Isometry3d& T_older_newer,
          const AlignConfig& align, const KeyframeGraphConfig& config);

/// Joins the newest keyframe with older ones near it, few of many being spread over all distances, and if it
/// was joined moves all keyframes to where the constraints want them.
void join_newest(KeyframeGraph& graph, const AlignConfig& align, const KeyframeGraphConfig& config);

/// Forgets all constraints and joins all keyframes anew, with the depth that they have by now, and solves.
void join_all(KeyframeGraph& graph, const ViewConfig& view, const AlignConfig& align,
              const KeyframeGraphConfig& config);

}  // namespace roomradar
