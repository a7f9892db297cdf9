// place_matching.hpp: which remembered views look like this one, and how they stand to each other.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// Positions in `places` of at most `count` views with the most features in common with `place`, the most
/// alike first; only those with at least `min_matches`. Looks at each view's `strongest` features.
std::vector<std::size_t> most_alike(const Place& place, std::span<const Place> places, std::size_t count,
                                    int min_matches, std::size_t strongest = 300);

/// A rigid motion that takes `inliers` of b's matched feature points onto a's.
struct PlaceMatch {
  int inliers = 0;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< only if inliers > 0
};

/// One point in two frames.
struct PointPair {
  Eigen::Vector3d a, b;  ///< m
  double gate_m;         ///< how far they may be apart once moved onto each other
};

/// The motion that most pairs agree on, by RANSAC over so many triples with a fixed seed, refined over all
/// inliers.
PlaceMatch motion_of(const std::vector<PointPair>& pairs, int samples);

/// Matches all features (nearest descriptor, clearly nearer than the second) and finds the motion that most
/// of their points agree on within the depth noise, by RANSAC over triples with a fixed seed, refined over
/// all inliers. Source: Fischler and Bolles 1981; Umeyama 1991; Lowe 2004 (ratio test).
PlaceMatch match_places(const Place& a, const Place& b);

}  // namespace roomradar
