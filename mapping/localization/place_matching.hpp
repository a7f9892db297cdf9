// place_matching.hpp: finds keyframes that look like a view, and their relative poses.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// Returns the indices in `places` of at most `count` keyframes with the most features in common with
/// `place`, best first, each with at least `min_matches`. Compares only each view's `strongest` features.
std::vector<std::size_t> most_alike(const MapKeyframe& place, std::span<const MapKeyframe> keyframe_database,
                                    std::size_t count, int min_matches, std::size_t strongest = 300);

/// Rigid motion that maps `inliers` of b's matched feature points onto a's.
struct KeyframeMatch {
  int inliers = 0;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< valid only if inliers > 0
};

/// Corresponding points in two frames.
struct PointPair {
  Eigen::Vector3d a, b;  ///< m
  double gate_m;         ///< max distance between the points after alignment
};

/// Computes the motion with the most inliers, by RANSAC over `samples` triples with a fixed seed, refined
/// over all inliers.
KeyframeMatch motion_of(const std::vector<PointPair>& pairs, int samples);

/// Matches all features (nearest descriptor, ratio test) and computes the motion that most of their points
/// agree on within the depth noise. RANSAC over triples with a fixed seed, refined over all inliers. Source:
/// Fischler and Bolles 1981; Umeyama 1991; Lowe 2004 (ratio test).
KeyframeMatch match_keyframes(const MapKeyframe& a, const MapKeyframe& b);

}  // namespace roomradar
