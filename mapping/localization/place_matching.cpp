// place_matching.cpp: finds keyframes that look like a view, and their relative poses.
#include "mapping/localization/place_matching.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <random>
#include <span>
#include <utility>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

constexpr int kMaxFeatureDistance_bits = 60;  // of 256
constexpr float kRatio = 0.85F;
// If a third of the matches is correct, one triple is with probability 1 - (1 - 1/27)^400 = 0.9999997.
constexpr int kSamples = 400;
constexpr std::size_t kMinMatches = 6;

using Descriptors = std::span<const Descriptor>;

using Words = std::array<std::uint64_t, 4>;

/// As distance_bits(a, b), where `a` is in registers. Compilers make of distance_bits() in a loop two copies
/// by way of the stack, which take longer than the rest.
int distance_to(const Words& a, const Descriptor& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::uint64_t word = 0;
    std::memcpy(&word, b.data() + i * sizeof(word), sizeof(word));
    bits += std::popcount(a[i] ^ word);
  }
  return bits;
}

/// Returns the index of the feature in `to` that is nearest to `feature`, if the second nearest is clearly
/// farther.
std::optional<std::size_t> match_of(const Descriptor& feature, Descriptors to) {
  const auto words = std::bit_cast<Words>(feature);
  int best = 257, second = 257;
  std::size_t nearest = 0;
  for (std::size_t j = 0; j < to.size(); ++j) {
    const int d = distance_to(words, to[j]);
    if (d < best) {
      second = std::exchange(best, d);
      nearest = j;
    } else if (d < second) {
      second = d;
    }
  }
  const bool is_match =
      best <= kMaxFeatureDistance_bits && static_cast<float>(best) < kRatio * static_cast<float>(second);
  return is_match ? std::optional(nearest) : std::nullopt;
}

/// Returns index pairs (from, to) of features that match.
std::vector<std::pair<std::size_t, std::size_t>> matches(Descriptors from, Descriptors to) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (const auto nearest = match_of(from[i], to)) pairs.emplace_back(i, *nearest);
  return pairs;
}

Descriptors strongest_of(const MapKeyframe& keyframe) {
  const Descriptors all = keyframe.descriptors;
  return all.first(std::min(FeatureIndex::kIndexedFeatures, all.size()));
}

/// Computes the best rigid motion of the chosen pairs' b onto a.
Eigen::Isometry3d rigid_motion(const std::vector<PointPair>& pairs, const std::vector<std::size_t>& chosen) {
  Eigen::Matrix3Xd a(3, static_cast<Eigen::Index>(chosen.size())), b = a;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    a.col(static_cast<Eigen::Index>(i)) = pairs[chosen[i]].a;
    b.col(static_cast<Eigen::Index>(i)) = pairs[chosen[i]].b;
  }
  return fit_rigid(b, a);
}

std::vector<std::size_t> inliers_of(const std::vector<PointPair>& pairs, const Eigen::Isometry3d& T_a_b) {
  std::vector<std::size_t> inliers;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if ((T_a_b * pairs[i].b - pairs[i].a).squaredNorm() < pairs[i].gate_m * pairs[i].gate_m)
      inliers.push_back(i);
  }
  return inliers;
}

/// Returns true if three pairs span a triangle that constrains the rotation, with equal sides in both frames.
bool is_usable_triple(const std::vector<PointPair>& pairs, const std::vector<std::size_t>& triple) {
  constexpr double kMinSide_m = 0.1;
  for (std::size_t i = 0; i < 3; ++i) {
    const PointPair& p = pairs[triple[i]];
    const PointPair& q = pairs[triple[(i + 1) % 3]];
    const double side_a = (p.a - q.a).norm(), side_b = (p.b - q.b).norm();
    if (side_a < kMinSide_m || std::abs(side_a - side_b) > p.gate_m + q.gate_m) return false;
  }
  const Eigen::Vector3d u = pairs[triple[1]].a - pairs[triple[0]].a,
                        v = pairs[triple[2]].a - pairs[triple[0]].a;
  return u.cross(v).norm() > 0.2 * u.norm() * v.norm();
}

}  // namespace

std::vector<std::size_t> most_alike(const MapKeyframe& place, const KeyframeDatabase& keyframe_database,
                                    std::size_t count, int min_matches,
                                    const std::function<bool(std::size_t)>& accept) {
  std::vector<std::size_t> candidates =
      keyframe_database.index.candidates(strongest_of(place), 40 + 2 * count, accept);
  for (std::size_t i = keyframe_database.index.size(); i < keyframe_database.keyframes.size(); ++i)
    if (!accept || accept(i)) candidates.push_back(i);
  return most_alike_of(candidates, place, keyframe_database, count, min_matches);
}

std::vector<std::size_t> most_alike_of(const std::vector<std::size_t>& candidates, const MapKeyframe& place,
                                       const KeyframeDatabase& keyframe_database, std::size_t count,
                                       int min_matches) {
  std::vector<std::pair<int, std::size_t>> votes;
  for (const std::size_t i : candidates) {
    const int found =
        static_cast<int>(matches(strongest_of(place), strongest_of(keyframe_database.keyframes[i])).size());
    if (found >= min_matches) votes.emplace_back(-found, i);
  }
  std::sort(votes.begin(), votes.end());
  std::vector<std::size_t> alike;
  for (const auto& [negative_votes, i] : votes) {
    if (alike.size() < count) alike.push_back(i);
  }
  return alike;
}

KeyframeMatch match_keyframes(const MapKeyframe& a, const MapKeyframe& b) {
  std::vector<PointPair> pairs;
  for (const auto& [i, j] : matches(b.descriptors, a.descriptors)) {
    const Eigen::Vector3f& pa = a.points_camera[j];
    const Eigen::Vector3f& pb = b.points_camera[i];
    const float sigma_m = depth_sigma_m(DepthNoise{}, std::max(pa.z(), pb.z()));
    pairs.push_back({pa.cast<double>(), pb.cast<double>(), 0.015 + 3.0 * static_cast<double>(sigma_m)});
  }
  return pairs.size() < kMinMatches ? KeyframeMatch{} : motion_of(pairs, kSamples);
}

KeyframeMatch motion_of(const std::vector<PointPair>& pairs, int samples) {
  constexpr std::size_t kMinPairs = 4;
  KeyframeMatch match;
  if (pairs.size() < kMinPairs) return match;

  std::mt19937 random(1);
  std::vector<std::size_t> best, triple(3);
  for (int sample = 0; sample < samples; ++sample) {
    for (std::size_t& i : triple) i = random() % pairs.size();
    if (!is_usable_triple(pairs, triple)) continue;
    std::vector<std::size_t> inliers = inliers_of(pairs, rigid_motion(pairs, triple));
    if (inliers.size() > best.size()) best = std::move(inliers);
  }
  for (int round = 0; round < 5 && best.size() >= kMinPairs; ++round) {
    match.T_a_b = rigid_motion(pairs, best);
    best = inliers_of(pairs, match.T_a_b);
    match.inliers = static_cast<int>(best.size());
  }
  return match;
}

}  // namespace roomradar
