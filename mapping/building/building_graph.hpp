// building_graph.hpp: places all recordings of a building in one world.
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

/// The keyframes of one submap, as the graph needs them.
struct GraphSubmap {
  std::vector<Eigen::Isometry3d> T_submap_keyframe;  ///< in order of time
  /// Poses in the building from an earlier result, one per keyframe. The submap keeps them unless they
  /// disagree with the joins by more than GraphConfig::keep_m. Empty: none.
  std::vector<Eigen::Isometry3d> T_building_keyframe;
};

/// A join between two submaps of the graph.
struct GraphJoin {
  std::size_t a = 0, b = 0;  ///< submaps
  SubmapJoin join;
};

/// Compares two submaps where a placement says that their keyframes have nearly the same view.
using TestOverlap =
    std::function<PlacementTest(std::size_t a, std::size_t b, std::span<const PredictedPair> pairs)>;

struct GraphConfig {
  /// Standard deviation of the relative pose of two successive keyframes of a submap.
  double step_sigma_m = 0.004, step_sigma_rad = 0.001;
  /// A join is refused if it is off by more than this after the solution, in m; rotations count 1 m per rad
  /// as seen from the keyframe.
  double max_off_m = 0.15;
  double keep_m = 0.01;
};

struct PlacedSubmap {
  std::vector<Eigen::Isometry3d> T_building_keyframe;  ///< one per keyframe
  std::size_t part = 0;   ///< submaps with the same number are connected; 0: with the first
  bool was_kept = false;  ///< has its earlier poses
};

struct BuildingGraph {
  std::vector<PlacedSubmap> submaps;
  std::vector<bool> is_used;  ///< by join: false if it contradicts the others
  std::vector<double> off_m;  ///< by join: median distance of its links from the solution, m
  std::size_t parts = 0;      ///< number of connected parts
};

/// Solves for all keyframes' poses. The joins have the status kJoined. The world is that of the first submap,
/// or of the kept ones. Chooses joins that do not contradict each other (join_choice.hpp), begins with a
/// spanning tree of those with the most agreeing keyframes, then adds the others as robust constraints, and
/// refuses those that remain off, the worst first, until all agree. Submaps that no join connects with the
/// first form parts of their own, each in the world of its first submap. Deterministic. Source: Kümmerle et
/// al., g2o, ICRA 2011 (pose graph).
BuildingGraph solve_building(std::span<const GraphSubmap> submaps, std::span<const GraphJoin> joins,
                             const TestOverlap& test_overlap = {}, const GraphConfig& config = {});

}  // namespace roomradar
