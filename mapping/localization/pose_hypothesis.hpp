// pose_hypothesis.hpp: pose hypotheses of a map search, and the tests that accept them.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/localization/depth_agreement.hpp"
#include "mapping/localization/patch_matching.hpp"

namespace roomradar {

/// Pose that a search of the map tried, with its agreement in appearance and depth.
struct PoseHypothesis {
  Tracking tracking;
  double uncertainty_m = 0.0;  ///< result of uncertainty_m() after alignment and patches
  PatchAgreement appearance;
  DepthAgreement agreement;
};

bool is_near(const Eigen::Isometry3d& T_world_a, const Eigen::Isometry3d& T_world_b, double reach_m,
             double reach_rad);

/// Returns the depth agreement, at most 1, over pixels where the model has a surface. Pixels that see through
/// the model count against the pose twice.
inline double fit_of(const DepthAgreement& agreement) {
  return agreement.alike_part() - 2.0 * agreement.farther_part();
}
/// Returns the sum of the agreement in depth and in appearance, at most 2.
double support_of(const PoseHypothesis& hypothesis);

/// Returns the standard deviation of the camera's position in its most uncertain direction, from depth and
/// patches. Infinite if a direction is unconstrained.
double uncertainty_m(const Tracking& tracking);

/// Returns whether enough patches match known ones at this pose. Where boards or tiles repeat, about twenty
/// match at a wrong pose. So if depth leaves a direction unconstrained, more must match, or almost nothing
/// may contradict the pose.
bool is_verified_by_patches(const PoseHypothesis& hypothesis);

/// Returns whether enough patches were compared, and a larger fraction of them is alike than at wrong poses.
bool is_supported_by_patches(const PatchAgreement& appearance);

/// Returns whether the pose is certain by itself. Either many patches match known ones and the depth does not
/// contradict the pose; or depth alone constrains the pose, almost no pixel sees through the model, and the
/// patches do not contradict it.
bool is_certain(const PoseHypothesis& hypothesis);

/// Returns whether the best pose is ambiguous: another pose explains the frame about as well. The margin is
/// larger for few patches, because their agreement differs between identical places by chance.
bool is_ambiguous(const PoseHypothesis& best, const std::vector<PoseHypothesis>& hypotheses);

/// Returns whether two poses are close enough to be the same place.
inline bool is_same_pose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kSame_m = 0.1, kSame_rad = 0.1;
  return is_near(a, b, kSame_m, kSame_rad);
}

/// Result of a search of the map.
enum class SearchEnd {
  kFound,
  kNoCandidate,  ///< neither appearance nor shape yields a pose
  kNotCertain,   ///< the best pose explains the frame too poorly, or has an unconstrained direction
  kAmbiguous,    ///< ambiguous: another pose explains the frame about as well
};
std::string_view to_string(SearchEnd end);

}  // namespace roomradar
