// submap_join.hpp: proves that two recordings show the same place, and measures their relative pose.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mapping/building/submap.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {

/// Measured relative pose of a keyframe of submap a and a keyframe of submap b.
struct KeyframeLink {
  std::size_t a = 0, b = 0;                                 ///< keyframes
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< of the two cameras
  /// Inverse covariance of T_a_b, as a twist (translation m, rotation rad) in the frame of camera b.
  Matrix6d information = Matrix6d::Identity();
};

enum class JoinStatus {
  kJoined,
  kNotRecognised,  ///< too few keyframes match, or they disagree
  /// The keyframes match, but elsewhere one recording saw through what the other measured as surface.
  kContradicted,
  /// The keyframes match, but others look different although they would show the same place: another room
  /// with the same furniture.
  kLooksDifferent,
};

/// Keyframes of two submaps that agree on where the submaps are to each other.
struct SubmapJoin {
  JoinStatus status = JoinStatus::kNotRecognised;
  std::vector<KeyframeLink> links;  ///< only if joined
  /// Relative pose of the submaps' worlds near the links. Elsewhere, drift of both adds to it.
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  int agreeing = 0;        ///< pairs of keyframes whose features agree on T_a_b
  int expected = 0;        ///< keyframes of b that overlap enough with one of a to be recognised in it
  int recognised = 0;      ///< of these, those that were recognised
  double agreement = 0.0;  ///< fraction of the common surface that is at the same place in both
};
/// Returns the end of a sentence for the user with the outcome and its numbers.
std::string describe(const SubmapJoin& join);

struct JoinConfig {
  int min_inliers = 20;         ///< features that agree on the relative pose of two keyframes
  int min_agreeing = 3;         ///< pairs of keyframes that agree on T_a_b
  double min_agreement = 0.75;  ///< see SubmapJoin::agreement
  double max_different = 0.25;  ///< max fraction of the expected keyframes that are not recognised
  double near_m = 6.0;          ///< farther from the links, drift of the submaps prevents a comparison
  std::size_t max_links = 60;   ///< the links are chosen evenly along b
};

/// Keyframes of two submaps that have nearly the same view where a placement puts the submaps.
struct PredictedPair {
  std::size_t a = 0, b = 0;                                 ///< keyframes
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< predicted relative pose of the two cameras
  double drift_m = 0.0;                                     ///< max assumed error of T_a_b
};

/// Adds the pairs of one keyframe of b with all keyframes of a that have nearly its view.
/// @param T_a_keyframe  poses of a's keyframes in a's world
/// @param T_a_b         predicted pose of the keyframe of b there
void predict_pairs(std::span<const Eigen::Isometry3d> T_a_keyframe, const Eigen::Isometry3d& T_a_b,
                   std::size_t b, double drift_m, std::vector<PredictedPair>& pairs);

/// What keyframes of b show of the places where a's keyframes say that they are.
struct PlacementTest {
  int expected = 0;    ///< keyframes of b that overlap enough with one of a to be recognised in it
  int recognised = 0;  ///< of these, those that were recognised at the predicted pose
  /// Most keyframes of b in a row, in order of time, that had to be recognised and none of which was.
  int longest_miss = 0;
  std::int64_t same = 0;     ///< pixels whose surface is at the same place in both
  std::int64_t through = 0;  ///< pixels where one saw through the other's surface

  /// Fraction of the common surface that is at the same place in both; 0 if there is none.
  [[nodiscard]] double agreement() const {
    const auto common = static_cast<double>(same + through);
    return common > 0.0 ? static_cast<double>(same) / common : 0.0;
  }
};

/// Tests a placement by the depth and the features of predicted pairs: of each keyframe of b, those with the
/// three most similar views. The pairs are in order of b.
PlacementTest test_placement(const Submap& a, const Submap& b, std::span<const PredictedPair> pairs);

/// Compares two submaps at all pairs of keyframes that look similar. Returns one join for each place where
/// they meet; if there is none, the reason. A join is proved by three tests: several pairs of keyframes agree
/// on one relative pose by their features; the depth of the keyframes around agrees, and none sees through
/// the other's surface; and keyframes that would show the same place are recognised in each other.
/// Links are refined by aligning the keyframes' depth in both directions; links whose results differ are
/// dropped. Source: as registration.hpp; Chen and Medioni 1992 (alignment).
std::vector<SubmapJoin> join_submaps(const Submap& a, const Submap& b,
                                     std::span<const std::pair<std::size_t, std::size_t>> keyframes,
                                     const JoinConfig& config = {});

}  // namespace roomradar
