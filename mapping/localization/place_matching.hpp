// place_matching.hpp: finds keyframes that look similar to a view, and their relative poses.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// Returns the indices in `keyframe_database` of the keyframes with the most feature matches to `place`, best
/// first. Returns at most `count` keyframes, each with at least `min_matches` matches. Compares only the
/// strongest FeatureIndex::kIndexedFeatures features of each keyframe. Compares all keyframes that are not in
/// the database's FeatureIndex, and the first 40 + 2 * `count` candidates() of the index. With a complete
/// index, the time hardly grows with the database.
/// @param accept  called with a keyframe's index; false: the keyframe is left out. Empty: all are accepted
std::vector<std::size_t> most_alike(const MapKeyframe& place, const KeyframeDatabase& keyframe_database,
                                    std::size_t count, int min_matches,
                                    const std::function<bool(std::size_t)>& accept = {});

/// Same as most_alike(), restricted to the keyframes with these indices.
std::vector<std::size_t> most_alike_of(const std::vector<std::size_t>& candidates, const MapKeyframe& place,
                                       const KeyframeDatabase& keyframe_database, std::size_t count,
                                       int min_matches);

/// Relative pose of two keyframes a and b, from their matched features.
struct KeyframeMatch {
  int inliers = 0;
  /// Rigid motion that maps the features' surface points from b to a, with `inliers` inliers. Valid only if
  /// inliers > 0.
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
};

/// One point, measured in two frames a and b.
struct PointPair {
  Eigen::Vector3d a, b;  ///< m
  double gate_m;         ///< max distance between a and T_a_b * b after alignment, m
};

/// Computes the rigid motion T_a_b with the most inliers, by RANSAC over `samples` triples, then refines it
/// over all inliers. Deterministic: the random seed is fixed.
KeyframeMatch motion_of(const std::vector<PointPair>& pairs, int samples);

/// Matches all features of two keyframes by nearest descriptor and ratio test. Computes the motion with the
/// most inliers within the depth noise; see motion_of(). Source: Fischler and Bolles 1981 (RANSAC); Umeyama
/// 1991 (rigid motion); Lowe 2004 (ratio test).
KeyframeMatch match_keyframes(const MapKeyframe& a, const MapKeyframe& b);

}  // namespace roomradar
