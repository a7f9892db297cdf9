// pose_hypothesis.cpp: agreement of a depth image with the depth expected at a pose; thresholds on the
// agreement in depth and appearance that accept a pose.
#include "mapping/localization/pose_hypothesis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

constexpr int kFewPatches = 12;  // with fewer, the fraction alike is meaningless and contradicts nothing
constexpr double kContradicted = 0.2;  // with more patches, a pose with a smaller fraction alike is wrong

}  // namespace

DepthAgreement depth_agreement_of(const DepthImage& depth_m, const DepthImage& expected_m) {
  constexpr int kStep_px = 4;
  constexpr float kAlike_per_m = 0.02F;  // in inverse depth; 5 steps of a Kinect's disparity are 0.014
  constexpr float kAlike_m = 0.006F;     // nearer than 0.55 m, a map's voxels of 1 cm are coarser than that
  DepthAgreement agreement;
  for (int y = 0; y < depth_m.height; y += kStep_px) {
    for (int x = 0; x < depth_m.width; x += kStep_px) {
      const float live = depth_m.at(x, y), expected = expected_m.at(x, y);
      if (!(live > 0.0F)) continue;
      ++agreement.valid;
      if (!(expected > 0.0F)) continue;
      ++agreement.both;
      const float gap_m = std::max(kAlike_per_m * live * expected, kAlike_m);
      agreement.alike += std::abs(live - expected) < gap_m;
      agreement.farther += live - expected >= gap_m;
    }
  }
  return agreement;
}

bool is_near(const Eigen::Isometry3d& T_world_a, const Eigen::Isometry3d& T_world_b, double reach_m,
             double reach_rad) {
  const Eigen::Isometry3d T_a_b = T_world_a.inverse() * T_world_b;
  return T_a_b.translation().norm() < reach_m && Eigen::AngleAxisd(T_a_b.linear()).angle() < reach_rad;
}

double support_of(const PoseHypothesis& hypothesis) {
  constexpr double kEnough = 0.4;  // fraction of the depth that the model must cover
  const DepthAgreement& agreement = hypothesis.agreement;
  const double covered = std::min(1.0, agreement.both / (kEnough * std::max(agreement.valid, 1)));
  return covered * fit_of(agreement) + static_cast<double>(hypothesis.appearance.alike.size()) /
                                           std::max(hypothesis.appearance.compared, kFewPatches);
}

double uncertainty_m(const Tracking& tracking) {
  if (!(symmetric_eigen(tracking.information).values(0) > 1e-3))
    return std::numeric_limits<double>::infinity();
  const Eigen::Matrix3d covariance_m2 = inverse(tracking.information).topLeftCorner<3, 3>();
  return std::sqrt(symmetric_eigen(covariance_m2).values(2));
}

bool is_verified_by_patches(const PoseHypothesis& hypothesis) {
  constexpr std::size_t kMany = 15, kManyAlone = 40, kManyUndisputed = 25;
  constexpr double kMinAlike = 0.35;
  constexpr double kUndisputed = 0.75, kUndisputedFit = 0.9;  // no wrong pose exceeds both
  const PatchAgreement& appearance = hypothesis.appearance;
  const bool is_undisputed =
      appearance.alike_part() > kUndisputed && fit_of(hypothesis.agreement) > kUndisputedFit;
  const std::size_t enough = hypothesis.tracking ? kMany : is_undisputed ? kManyUndisputed : kManyAlone;
  return appearance.alike.size() >= enough && appearance.alike_part() > kMinAlike;
}

bool is_supported_by_patches(const PatchAgreement& appearance) {
  return appearance.compared >= kFewPatches && appearance.alike_part() > kContradicted;
}

bool is_certain(const PoseHypothesis& hypothesis) {
  constexpr double kMostUncertain_m = 0.015;  // 5 cm are more than three standard deviations
  // People stand in front of known surfaces, never behind them. If depth leaves a direction unconstrained,
  // floorboards repeat along it, and only a few edges can show that the pose is wrong.
  constexpr double kMostFarther = 0.12, kMostFartherOpen = 0.05;
  // In this case two thirds of some hundred patches may be alike at a wrong pose, but the depth then agrees
  // less. So the depth must agree clearly, or depth and patches together.
  constexpr double kClearTogether = 1.53, kClearDepth = 0.95;
  const DepthAgreement& agreement = hypothesis.agreement;
  const PatchAgreement& appearance = hypothesis.appearance;
  if (!has_pose(hypothesis.tracking) || hypothesis.uncertainty_m > kMostUncertain_m ||
      agreement.both < 0.2 * agreement.valid)
    return false;
  if (is_verified_by_patches(hypothesis)) {
    const bool is_clear = hypothesis.tracking || agreement.alike_part() > kClearDepth ||
                          appearance.alike_part() + agreement.alike_part() > kClearTogether;
    return is_clear && fit_of(agreement) > 0.4 &&
           agreement.farther_part() < (hypothesis.tracking ? kMostFarther : kMostFartherOpen);
  }
  if (!hypothesis.tracking || agreement.both < 0.5 * agreement.valid || agreement.farther_part() > 0.03)
    return false;
  if (appearance.compared < kFewPatches) return agreement.alike_part() > 0.9;
  return appearance.alike_part() > kContradicted &&
         agreement.alike_part() > (appearance.alike.size() > kFewPatches ? 0.7 : 0.9);
}

bool is_ambiguous(const PoseHypothesis& best, const std::vector<PoseHypothesis>& hypotheses) {
  constexpr double kClear = 0.08, kChance = 0.8;  // two standard deviations of the fraction alike for one
                                                  // patch
  return std::any_of(hypotheses.begin(), hypotheses.end(), [&](const PoseHypothesis& other) {
    const int compared = std::min(best.appearance.compared, other.appearance.compared);
    const double chance = compared >= kFewPatches ? kChance / std::sqrt(compared) : 0.0;
    return !is_same_pose(best.tracking.T_world_camera, other.tracking.T_world_camera) &&
           has_pose(other.tracking) && support_of(other) > support_of(best) - kClear - chance;
  });
}

std::string_view to_string(SearchEnd end) {
  switch (end) {
    case SearchEnd::kFound:
      return "found";
    case SearchEnd::kNoCandidate:
      return "no candidate";
    case SearchEnd::kNotCertain:
      return "not certain";
    case SearchEnd::kAmbiguous:
      return "ambiguous";
  }
  return "unknown";
}

}  // namespace roomradar
