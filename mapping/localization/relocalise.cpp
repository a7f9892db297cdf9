// relocalise.cpp: localises a frame in the keyframe database.
#include "mapping/localization/relocalise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/localization/keyframe_proof.hpp"
#include "mapping/localization/place_matching.hpp"

namespace roomradar {
namespace {

/// Verifies a keyframe without features. Alignment starts at the keyframe's pose, must constrain all
/// directions, overlap well, and agree with the reverse alignment.
KeyframeProof prove_with_depth(const SourcePoints& live, const TargetView& live_reference,
                               const MapKeyframe& place, const ViewConfig& view) {
  constexpr double kMinAgreement = 0.85, kMinOverlap = 0.6, kMaxGap_m = 0.03, kMaxGap_rad = 0.03;
  const AlignConfig wide{.coarsest_level = 2, .iterations = 12, .gate_m = 0.3F, .intensity_sigma = 0.0F};
  KeyframeProof proof;
  ViewPyramid preview;
  make_preview_pyramid(place, view, preview);
  proof.target = target_of(preview, view);
  const Tracking there = align(live, proof.target, Eigen::Isometry3d::Identity(), wide);
  proof.T_keyframe_camera = there.T_world_camera;
  proof.agreement = there.inlier_fraction;
  if (!there || there.overlap < kMinOverlap || there.inlier_fraction < kMinAgreement) return proof;
  SourcePoints place_live;
  make_source_points(preview, place_live);
  const Tracking back = align(place_live, live_reference, there.T_world_camera.inverse(), wide);
  const Eigen::Isometry3d gap = there.T_world_camera * back.T_world_camera;
  proof.holds = back && back.inlier_fraction >= kMinAgreement && gap.translation().norm() < kMaxGap_m &&
                Eigen::AngleAxisd(gap.linear()).angle() < kMaxGap_rad;
  return proof;
}

/// Returns the indices of at most `count` keyframes whose depth is most similar to the frame's, ray by ray.
/// For other keyframes, alignment starting at their pose would have almost no points within its gate.
std::vector<std::size_t> nearest_in_depth(const Frame& frame, const KeyframeDatabase& keyframe_database,
                                          std::size_t count, const std::function<bool(std::size_t)>& accept) {
  constexpr int kEvery_px = 8;  // pixels of a preview
  constexpr float kGate_m = 0.3F;
  std::vector<std::pair<int, std::size_t>> unlike;
  for (std::size_t i = 0; i < keyframe_database.keyframes.size(); ++i) {
    if (accept && !accept(i)) continue;
    const MapKeyframe& place = keyframe_database.keyframes[i];
    int alike = 0;
    for (int v = kEvery_px / 2; v < place.preview_camera.height_px; v += kEvery_px) {
      for (int u = kEvery_px / 2; u < place.preview_camera.width_px; u += kEvery_px) {
        const float place_m = 0.001F * static_cast<float>(place.preview_depth_mm.at(u, v));
        const Eigen::Vector2d at =
            project(frame.depth_camera, back_project(place.preview_camera, u, v, 1.0)).array().round();
        const bool is_seen =
            (at.array() >= 0.0).all() && at.x() < frame.depth_m.width && at.y() < frame.depth_m.height;
        if (place_m == 0.0F || !is_seen) continue;
        const float depth_m = frame.depth_m.at(static_cast<int>(at.x()), static_cast<int>(at.y()));
        if (depth_m > 0.0F && std::abs(depth_m - place_m) < kGate_m) ++alike;
      }
    }
    unlike.emplace_back(-alike, i);
  }
  const auto end = unlike.begin() + static_cast<std::ptrdiff_t>(std::min(count, unlike.size()));
  std::partial_sort(unlike.begin(), end, unlike.end());
  std::vector<std::size_t> nearest;
  std::transform(unlike.begin(), end, std::back_inserter(nearest), [](const auto& of) { return of.second; });
  return nearest;
}

}  // namespace

std::string_view to_string(RelocalisationStatus status) {
  switch (status) {
    case RelocalisationStatus::kFound:
      return "found";
    case RelocalisationStatus::kNoKeyframes:
      return "no keyframes";
    case RelocalisationStatus::kNoDepth:
      return "no depth";
    case RelocalisationStatus::kNoMatch:
      return "no match";
    case RelocalisationStatus::kNotVerified:
      return "not verified";
  }
  return "unknown";
}

Relocalisation relocalise(const Frame& frame, const KeyframeDatabase& keyframe_database,
                          const RelocaliseConfig& config, const std::function<bool(std::size_t)>& accept) {
  Relocalisation none;
  if (keyframe_database.keyframes.empty()) {
    none.status = RelocalisationStatus::kNoKeyframes;
    return none;
  }
  const ViewConfig view{.finest_width_px = config.place.preview_width_px, .normal_reach_px = 2};
  ViewPyramid pyramid;
  SourcePoints live;
  make_pyramid(frame.depth_m, frame.depth_camera, view, pyramid, frame.depth_noise);
  make_source_points(pyramid, live);
  constexpr std::size_t kMinPoints = 200;
  if (live.levels.front().size() < kMinPoints) {
    none.status = RelocalisationStatus::kNoDepth;
    return none;
  }

  std::vector<KeyframeWitness> witnesses;
  const bool remembered_by_features =
      std::any_of(keyframe_database.keyframes.begin(), keyframe_database.keyframes.end(),
                  [](const MapKeyframe& place) { return !place.descriptors.empty(); });
  if (!frame.colour.empty() && remembered_by_features) {
    constexpr int kMinMatches = 8;
    const MapKeyframe here = make_map_keyframe(frame, Eigen::Isometry3d::Identity(), config.place);
    const auto most = static_cast<std::size_t>(std::max(config.candidates, 0));
    for (const std::size_t i : most_alike(here, keyframe_database, most, kMinMatches, accept)) {
      const KeyframeMatch match = match_keyframes(keyframe_database.keyframes[i], here);
      if (match.inliers < config.min_feature_inliers) continue;
      none.status = RelocalisationStatus::kNotVerified;
      KeyframeProof proof =
          prove_with_features(live, keyframe_database.keyframes[i], match, config.min_depth_agreement, view);
      if (proof.holds) witnesses.push_back({i, match.inliers, std::move(proof)});
    }
  } else {
    constexpr std::size_t kMostByDepth = 40;  // each takes some milliseconds
    const TargetView live_reference = target_of(pyramid, view);
    for (const std::size_t i : nearest_in_depth(frame, keyframe_database, kMostByDepth, accept)) {
      KeyframeProof proof = prove_with_depth(live, live_reference, keyframe_database.keyframes[i], view);
      if (proof.holds) witnesses.push_back({i, 0, std::move(proof)});
    }
  }
  if (witnesses.empty()) return none;
  const KeyframeWitness& best = best_of(witnesses);
  return {.status = RelocalisationStatus::kFound,
          .T_world_camera = joint_pose(witnesses, best, live, keyframe_database),
          .keyframe = static_cast<std::int64_t>(best.keyframe),
          .feature_inliers = best.feature_inliers,
          .depth_agreement = best.proof.agreement};
}

}  // namespace roomradar
