// submap_overlap.hpp: compares two submaps where they overlap according to a placement (estimated relative
// pose).
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/building/submap.hpp"

namespace roomradar {

/// A keyframe of submap a and a keyframe of submap b that have nearly the same view according to a placement.
struct PredictedPair {
  std::size_t a = 0, b = 0;                                 ///< keyframes
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< predicted relative pose of the two cameras
  double drift_m = 0.0;                                     ///< max assumed error of T_a_b
};

/// Adds the pairs of one keyframe of b with all keyframes of a that have nearly the same view.
/// @param T_a_keyframe  poses of a's keyframes in a's world frame
/// @param T_a_b         predicted pose of the keyframe of b in a's world frame
void predict_pairs(std::span<const Eigen::Isometry3d> T_a_keyframe, const Eigen::Isometry3d& T_a_b,
                   std::size_t b, double drift_m, std::vector<PredictedPair>& pairs);

/// Result of comparing keyframes of b with those of a at their predicted relative poses.
struct PlacementTest {
  int expected = 0;    ///< number of keyframes of b that overlap a keyframe of a enough to be recognised
  int recognised = 0;  ///< number of expected keyframes that were recognised at the predicted pose
  /// Max number of consecutive expected keyframes, in order of time, of which none was recognised.
  int longest_miss = 0;
  std::int64_t same = 0;     ///< pixels whose surface is at the same place in both
  std::int64_t through = 0;  ///< pixels where one saw through the other's surface

  /// Fraction of the common surface that is at the same place in both; 0 if there is none.
  [[nodiscard]] double agreement() const {
    const auto common = static_cast<double>(same + through);
    return common > 0.0 ? static_cast<double>(same) / common : 0.0;
  }
};

/// Tests a placement by the depth and the features of predicted pairs. Per keyframe of b, uses the three
/// pairs with the most similar views. `pairs` must be in order of b.
PlacementTest test_placement(const Submap& a, const Submap& b, std::span<const PredictedPair> pairs);

}  // namespace roomradar
