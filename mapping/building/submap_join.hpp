// submap_join.hpp: proves that two recordings show the same place, and measures their relative pose; writes
// and reads the result.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <filesystem>
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
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< relative pose of the two cameras
  /// Inverse covariance of T_a_b, as a twist (translation m, rotation rad) in the frame of camera b.
  Matrix6d information = Matrix6d::Identity();
};

enum class JoinStatus {
  kJoined,
  kNotRecognised,  ///< too few keyframes match, or their relative poses or depths disagree
  /// The keyframes match, but elsewhere one recording sees through a surface that the other measured.
  kContradicted,
  /// Some keyframes match, but others that would show the same place look different. Example: another room
  /// with the same furniture.
  kLooksDifferent,
};

/// Relative pose of two submaps, with the keyframe pairs that support it.
struct SubmapJoin {
  JoinStatus status = JoinStatus::kNotRecognised;
  /// With kJoined: refined by depth. With another status: as estimated from features where the submaps look
  /// alike, with `information` not set.
  std::vector<KeyframeLink> links;
  /// Relative pose of the submaps' world frames, measured at the links. Farther from the links, its error
  /// grows by the drift of both submaps.
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  int agreeing = 0;        ///< number of keyframes of b whose features agree on T_a_b
  int expected = 0;        ///< number of keyframes of b that overlap a keyframe of a enough to be recognised
  int recognised = 0;      ///< number of expected keyframes that were recognised
  double agreement = 0.0;  ///< fraction of the common surface that is at the same place in both
};
/// Returns the end of a sentence for the user with the outcome and its numbers.
std::string describe(const SubmapJoin& join);

struct JoinConfig {
  int min_inliers = 20;         ///< features that agree on the relative pose of two keyframes
  int min_agreeing = 3;         ///< min keyframes of b that agree on T_a_b
  double min_agreement = 0.75;  ///< see SubmapJoin::agreement
  double max_different = 0.25;  ///< max fraction of expected keyframes not recognised; one is always allowed
  /// Max distance of compared keyframes from the links; beyond, drift is too large.
  double near_m = 6.0;
  std::size_t max_links = 60;  ///< max links of a join, spread evenly along b
};

/// Returns up to `count` of the values, evenly spread over them, in their order.
template <typename Value>
std::vector<Value> spread_evenly(const std::vector<Value>& values, std::size_t count) {
  count = std::min(count, values.size());
  std::vector<Value> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(values[i * values.size() / count]);
  return chosen;
}

/// Compares two submaps at pairs of keyframes that look similar. Returns one join per place that both submaps
/// show. If there is none, returns one join whose status is the reason. A join must pass three tests:
///   1. Several pairs of keyframes agree on one relative pose by their features.
///   2. The depth of nearby keyframes agrees, and none sees through the other submap's surface.
///   3. Keyframes that would show the same place are recognised in each other.
/// Links are refined by aligning the keyframes' depth in both directions. Links whose two results differ are
/// dropped. Source: Chen and Medioni 1992 (alignment).
std::vector<SubmapJoin> join_submaps(const Submap& a, const Submap& b,
                                     std::span<const std::pair<std::size_t, std::size_t>> keyframes,
                                     const JoinConfig& config = {});

/// Writes the outcome of comparing two submaps. Throws Error if the file cannot be written.
void save_joins(const std::vector<SubmapJoin>& joins, const std::filesystem::path& path);
/// Reads the joins. Throws Error naming the file and the fault if it is missing, damaged or of another
/// version.
std::vector<SubmapJoin> load_joins(const std::filesystem::path& path);

}  // namespace roomradar
