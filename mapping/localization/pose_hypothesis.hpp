// pose_hypothesis.hpp: camera pose hypotheses of a relocalisation, their agreement in depth, and the
// tests that accept or reject them.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/localization/patch_matching.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Pixel counts over every fourth pixel of every fourth row of a depth image.
struct DepthAgreement {
  int valid = 0;  ///< number of pixels with a measurement
  int both = 0;   ///< number of valid pixels at which the map's model has a surface, too
  /// Number of pixels in `both` whose two inverse depths differ by less than 0.02 / m, or whose depths differ
  /// by less than 6 mm. The tolerance covers sensor noise, voxels and distortion of the map.
  int alike = 0;
  /// Number of pixels in `both` whose measured depth is beyond the model's surface by more than the tolerance
  /// of `alike`.
  int farther = 0;

  [[nodiscard]] double alike_part() const { return both > 0 ? static_cast<double>(alike) / both : 0.0; }
  [[nodiscard]] double farther_part() const { return both > 0 ? static_cast<double>(farther) / both : 0.0; }
  /// Returns the agreement, at most 1. Each pixel beyond the model's surface reduces the score by 2 / valid.
  /// The camera cannot look through a wall, so only a removed object explains such a pixel. Nearer pixels do
  /// not reduce the score, since objects may have been added.
  [[nodiscard]] double score() const { return valid > 0 ? (alike - 2.0 * farther) / valid : 0.0; }
};

/// Compares the measured with the expected depth. Both images must have the same size.
DepthAgreement depth_agreement_of(const DepthImage& depth_m, const DepthImage& expected_m);

/// Candidate pose of a relocalisation, with its agreement in appearance and depth.
struct PoseHypothesis {
  Tracking tracking;
  /// uncertainty_m() of the final `tracking`. Where depth left directions unconstrained, the matched patches
  /// constrain them.
  double uncertainty_m = 0.0;
  PatchAgreement appearance;
  DepthAgreement agreement;
};

bool is_near(const Eigen::Isometry3d& T_world_a, const Eigen::Isometry3d& T_world_b, double reach_m,
             double reach_rad);

/// Returns the depth agreement, at most 1. It is computed over the pixels where the model has a surface: the
/// fraction that agrees minus twice the fraction that sees through the model's surface.
inline double fit_of(const DepthAgreement& agreement) {
  return agreement.alike_part() - 2.0 * agreement.farther_part();
}
/// Returns the sum of the agreement in depth and in appearance, at most 2. The hypothesis with the highest
/// sum is the best.
double support_of(const PoseHypothesis& hypothesis);

/// Returns the standard deviation of the camera's position in its most uncertain direction, m. Infinite if a
/// direction is unconstrained.
double uncertainty_m(const Tracking& tracking);

/// Returns true if enough patches match known patches at this pose. If depth constrains all directions, 15
/// suffice. Where floorboards or tiles repeat, about twenty patches match even at a wrong pose. If depth
/// leaves a direction unconstrained, 40 patches must therefore match, or 25 if more than 75 % of the compared
/// patches match and fit_of() > 0.9. In addition, more than 35 % of the compared patches must match.
bool is_verified_by_patches(const PoseHypothesis& hypothesis);

/// Returns true if at least 12 patches were compared, and more than 20 % of them match. At wrong poses, fewer
/// patches match.
bool is_supported_by_patches(const PatchAgreement& appearance);

/// Returns true if the pose is certain, without regard to other hypotheses. Its uncertainty must be at most
/// 15 mm, and the model must cover 20 % of the valid depth. In addition, patches or depth must verify the
/// pose. Patches verify the pose if is_verified_by_patches() and the depth does not contradict the pose.
/// Depth verifies the pose if depth constrains all directions, the patches do not contradict the pose, and
/// three limits hold. The model must cover half of the valid depth. At most 3 % of the common pixels may see
/// through the model. More than 90 % must agree (70 % if more than 12 patches match).
bool is_certain(const PoseHypothesis& hypothesis);

/// Returns true if another hypothesis, at a different pose, explains the frame about as well as `best`. With
/// few compared patches, `best` needs a larger lead, since the fraction of matching patches then varies more
/// by chance.
bool is_ambiguous(const PoseHypothesis& best, const std::vector<PoseHypothesis>& hypotheses);

/// Returns true if two poses differ by less than 0.1 m and 0.1 rad.
inline bool is_same_pose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kSame_m = 0.1, kSame_rad = 0.1;
  return is_near(a, b, kSame_m, kSame_rad);
}

/// Result of a relocalisation.
enum class SearchEnd {
  kFound,
  kNoCandidate,  ///< neither appearance nor shape gave a pose hypothesis
  kNotCertain,   ///< the best pose is not certain; see is_certain()
  kAmbiguous,    ///< another pose explains the frame about as well; see is_ambiguous()
};
std::string_view to_string(SearchEnd end);

}  // namespace roomradar
