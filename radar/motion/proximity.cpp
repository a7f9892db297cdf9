// proximity.cpp: traverses the object's tree with each of the scene's and tests pairs of triangles.
#include "radar/motion/proximity.hpp"

#include <algorithm>
#include <cmath>

#include "radar/geometry/infinity.hpp"
#include "radar/geometry/tree_pairs.hpp"
#include "radar/motion/closest_features.hpp"

namespace roomradar {
namespace {

bool is_far_from(const FrameTriangle& t, const PairBox& box, double reach_m) {
  return std::abs(t.normal.dot(box.centre.cast<double>() - t.corners[0])) -
             t.normal.cwiseAbs().dot(box.half.cast<double>()) >
         reach_m;
}

/// Returns true if the contents of two boxes may be within reach.
bool may_be_near(TreePair& trees, const PairBox& o, const PairBox& s, const FeatureCollector& places) {
  const double reach_m = places.reach_m;
  const Eigen::Array3f apart = (o.centre - s.centre).array().abs() - o.half.array() - s.half.array();
  if (apart.maxCoeff() > static_cast<float>(reach_m)) return false;
  if (are_large_against(o, s)) {
    const auto triangles = trees.of_object(o);
    return std::any_of(triangles.begin(), triangles.end(),
                       [&](const FrameTriangle& t) { return !is_far_from(t, s, reach_m); });
  }
  if (are_large_against(s, o)) {
    const auto triangles = trees.of_scene(s);
    return std::any_of(triangles.begin(), triangles.end(), [&](const FrameTriangle& t) {
      return !is_far_from(t, o, reach_m) && !(places.scene_is_one_sided && is_behind(t, o));
    });
  }
  return true;
}

/// Examines all pairs of two leaves' triangles. Returns true if any cross.
bool look_at_leaves(TreePair& trees, const PairBox& o, const PairBox& s, const FeatureCollector& places) {
  bool crosses = false;
  for (const FrameTriangle& scene : trees.of_scene(s))
    for (const FrameTriangle& object : trees.of_object(o)) crosses = places.look(object, scene) || crosses;
  return crosses;
}

}  // namespace

SurfaceKindMask near_features(const TreeInstance& object, const RadarScene& scene, double reach_m,
                              SurfaceKindMask left_out, const TreeStates& states,
                              std::vector<ClosestPoint>& points) {
  thread_local PendingPairs pending;                            // scratch
  thread_local std::vector<ClosestPoint> found, refused, kept;  // scratch
  points.clear();
  SurfaceKindMask crossed = 0;
  if (!is_usable(object) || !(reach_m > 0.0)) return crossed;
  for (std::uint32_t number = 0; number < scene.trees.size(); ++number) {
    const SceneTree& tree = scene.trees[number];
    if (!is_usable(tree.instance) || (left_out & bit_of(tree.kind)) != 0) continue;
    if (states.is_left_out(number)) continue;
    if (are_farther_apart(object, tree.instance, reach_m)) continue;
    found.clear();
    refused.clear();
    TreePair trees(object, tree.instance);
    const FeatureCollector places{reach_m,   object.tree->is_closed(), is_one_sided(tree.kind),
                                  tree.kind, trees.T_world_frame,      found,
                                  refused};
    bool crosses = false;
    visit_pairs<PairOrder::kAny>(
        trees, pending,
        [&](const PairBox& o, const PairBox& s) {
          return may_be_near(trees, o, s, places) ? 0.0F : kInfinity<float>;
        },
        [&](const PairBox& o, const PairBox& s) {
          crosses = look_at_leaves(trees, o, s, places);
          return crosses ? -kInfinity<float> : kInfinity<float>;
        });
    if (crosses) {
      crossed |= bit_of(tree.kind);
      continue;
    }
    places.erase_refused();
    for (ClosestPoint& point : found) point.tree = number;
    keep_the_outermost(found, kept);
    points.insert(points.end(), kept.begin(), kept.end());
  }
  return crossed;
}

}  // namespace roomradar
