// building_graph.hpp: places all recordings of a building in one world frame.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mapping/building/submap_join.hpp"
#include "mapping/building/submap_overlap.hpp"

namespace roomradar {

/// The keyframes of one submap (the trajectory and keyframes of one recording, see submap.hpp).
struct GraphSubmap {
  std::vector<Eigen::Isometry3d> T_submap_keyframe;  ///< in order of time
  /// Poses in the building from an earlier result, one per keyframe. The submap keeps them unless they
  /// disagree with the joins by more than GraphConfig::keep_m. Empty: none.
  std::vector<Eigen::Isometry3d> T_building_keyframe;
};

/// A join (measured relative pose, with the keyframe pairs that support it) between two submaps of the graph.
struct GraphJoin {
  std::size_t a = 0, b = 0;  ///< indices of the two submaps
  SubmapJoin join;
};

/// Callback that compares two submaps at the pairs of keyframes which have nearly the same view according to
/// the joins.
using TestOverlap =
    std::function<PlacementTest(std::size_t a, std::size_t b, std::span<const PredictedPair> pairs)>;

struct GraphConfig {
  /// Standard deviation of the relative pose of two successive keyframes of a submap.
  double step_sigma_m = 0.004, step_sigma_rad = 0.001;
  /// Max median error, m, of a join's links (keyframe pairs with a measured relative pose) after the
  /// solution. A rotation error of 1 rad counts as 1 m. Joins above the limit are refused.
  double max_off_m = 0.15;
  double keep_m = 0.01;
};

struct PlacedSubmap {
  std::vector<Eigen::Isometry3d> T_building_keyframe;  ///< one per keyframe
  std::size_t part = 0;   ///< number of its connected component; 0: that of the first submap
  bool was_kept = false;  ///< true: it has its earlier poses
};

struct BuildingGraph {
  std::vector<PlacedSubmap> submaps;
  std::vector<bool> is_used;  ///< per join: false if it contradicts the others
  std::vector<double> off_m;  ///< per join: median error of its links after the solution, m
  std::size_t parts = 0;      ///< number of connected components
};

/// Solves for all keyframes' poses. All joins must have the status kJoined. First chooses joins that do not
/// contradict each other (join_choice.hpp). Initial poses come from a spanning tree of the joins with the
/// most agreeing keyframes. The other joins are then added as robust constraints. Joins with an error above
/// max_off_m are refused, the worst first, until none is left. The world frame of a connected component is
/// that of its submaps' earlier poses, or of its first submap if none has earlier poses. Deterministic.
/// Source: Kümmerle et al., g2o, ICRA 2011 (pose graph).
BuildingGraph solve_building(std::span<const GraphSubmap> submaps, std::span<const GraphJoin> joins,
                             const TestOverlap& test_overlap = {}, const GraphConfig& config = {});

}  // namespace roomradar
