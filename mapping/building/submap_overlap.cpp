// submap_overlap.cpp: depth of the previews, and features, of keyframes with nearly the same view.
#include "mapping/building/submap_overlap.hpp"

#include <algorithm>
#include <utility>

#include "mapping/localization/keyframe_proof.hpp"
#include "mapping/localization/place_matching.hpp"
#include "mapping/localization/pose_hypothesis.hpp"
#include "mapping/odometry/keyframe_graph.hpp"

namespace roomradar {
namespace {

/// Tests one keyframe of b against those of a with nearly its view. Sorts the pairs.
/// @param[in,out] miss  keyframes before it, in a row, that were not recognised
void test_keyframe(const Submap& a, const MapKeyframe& view, std::vector<PredictedPair>& pairs, int& miss,
                   PlacementTest& test) {
  constexpr double kOverlap = 0.4;         // of the view's pixels
  constexpr std::size_t kDescribed = 100;  // features, below which a view need not be recognised
  constexpr std::size_t kMostPartners = 3;
  constexpr int kInliers = 10;
  std::sort(pairs.begin(), pairs.end(), [](const PredictedPair& x, const PredictedPair& y) {
    return std::pair(view_distance(x.T_a_b), x.a) < std::pair(view_distance(y.T_a_b), y.a);
  });
  bool is_expected = false, is_recognised = false;
  for (std::size_t p = 0; p < std::min(pairs.size(), kMostPartners); ++p) {
    const MapKeyframe& other = a.keyframes.keyframes.at(pairs[p].a);
    const Eigen::Isometry3d& T_other_view = pairs[p].T_a_b;
    const PreviewOverlap forth = compare_previews(view, other, T_other_view, pairs[p].drift_m);
    const PreviewOverlap back = compare_previews(other, view, T_other_view.inverse(), pairs[p].drift_m);
    test.same += forth.same + back.same;
    test.through += forth.through + back.through;
    const int both = forth.same + forth.through;
    if (both < kOverlap * forth.valid || is_recognised) continue;
    if (std::min(view.descriptors.size(), other.descriptors.size()) < kDescribed) continue;
    is_expected = true;
    const KeyframeMatch match = match_keyframes(other, view);
    is_recognised =
        match.inliers >= kInliers && is_near(match.T_a_b, T_other_view, 0.25 + pairs[p].drift_m, 0.15);
  }
  test.expected += is_expected ? 1 : 0;
  test.recognised += is_recognised ? 1 : 0;
  if (is_expected) miss = is_recognised ? 0 : miss + 1;
  test.longest_miss = std::max(test.longest_miss, miss);
}

}  // namespace

void predict_pairs(std::span<const Eigen::Isometry3d> T_a_keyframe, const Eigen::Isometry3d& T_a_b,
                   std::size_t b, double drift_m, std::vector<PredictedPair>& pairs) {
  constexpr double kSimilarView = 0.6;  // of view_distance()
  for (std::size_t a = 0; a < T_a_keyframe.size(); ++a)
    if (const Eigen::Isometry3d T = T_a_keyframe[a].inverse() * T_a_b; view_distance(T) < kSimilarView)
      pairs.push_back({a, b, T, drift_m});
}

PlacementTest test_placement(const Submap& a, const Submap& b, std::span<const PredictedPair> pairs) {
  PlacementTest test;
  int miss = 0;
  std::vector<PredictedPair> of_one;
  for (auto at = pairs.begin(); at != pairs.end();) {
    const auto end =
        std::find_if(at, pairs.end(), [&](const PredictedPair& pair) { return pair.b != at->b; });
    of_one.assign(at, end);
    test_keyframe(a, b.keyframes.keyframes.at(at->b), of_one, miss, test);
    at = end;
  }
  return test;
}

}  // namespace roomradar
