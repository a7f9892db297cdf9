// recognise_place.cpp: candidates by features, verification by depth, then a search for rival poses.
#include "mapping/localization/recognise_place.hpp"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "mapping/alignment/keyframe.hpp"
#include "mapping/localization/keyframe_proof.hpp"
#include "mapping/localization/place_matching.hpp"
#include "mapping/localization/pose_hypothesis.hpp"

namespace roomradar {
namespace {

constexpr int kMinFeatureMatches = 8;
constexpr std::size_t kMinPoints = 200;
constexpr double kSamePose_m = 0.3, kSamePose_rad = 0.3;
constexpr double kElsewhere_m = 3.0;   // about a room's width
constexpr std::size_t kWitnesses = 3;  // more cost time and hardly improve the pose
constexpr double kRivalPart = 0.5;     // of the best pose's inliers

/// A frame, prepared for comparison with keyframes.
struct Query {
  MapKeyframe features;
  SourcePoints points;
  ViewConfig view;
};

/// Proves the frame's pose by the keyframes most similar to it, until kWitnesses agree with the first.
/// @param min_inliers  of features, in a keyframe
/// @param was_matched  set if a keyframe has as many
std::vector<KeyframeWitness> witnesses_of(const Query& query, const KeyframeDatabase& database,
                                          const RelocaliseConfig& config, int min_inliers,
                                          const std::function<bool(std::size_t)>& accept, bool& was_matched) {
  std::vector<KeyframeWitness> witnesses;
  std::size_t agreeing = 0;
  const auto most = static_cast<std::size_t>(std::max(config.candidates, 0));
  for (const std::size_t i : most_alike(query.features, database, most, kMinFeatureMatches, accept)) {
    const KeyframeMatch match = match_keyframes(database.keyframes[i], query.features);
    if (match.inliers < min_inliers) continue;
    was_matched = true;
    KeyframeProof proof = prove_with_features(query.points, database.keyframes[i], match,
                                              config.min_depth_agreement, query.view);
    if (!proof.holds) continue;
    witnesses.push_back({i, match.inliers, std::move(proof)});
    agreeing += is_near(pose_by(witnesses.back(), database), pose_by(witnesses.front(), database),
                        kSamePose_m, kSamePose_rad)
                    ? 1
                    : 0;
    if (agreeing == kWitnesses) break;
  }
  return witnesses;
}

/// Pixels of the frame and of the keyframes with a similar view that show the same surface, and those through
/// which one of the two saw.
struct SurfaceCount {
  int same = 0, through = 0;
  [[nodiscard]] double agreement() const { return static_cast<double>(same) / std::max(same + through, 1); }
};

SurfaceCount count_surface(const MapKeyframe& frame, const Eigen::Isometry3d& T_world_camera,
                           const KeyframeDatabase& database) {
  constexpr double kSimilarView = 1.5;  // of view_distance()
  constexpr std::size_t kMost = 8;
  constexpr double kTolerance_m = 0.05;
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < database.keyframes.size(); ++i) {
    const double apart = view_distance(database.keyframes[i].T_world_camera.inverse() * T_world_camera);
    if (apart < kSimilarView) near.emplace_back(apart, i);
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), kMost));
  SurfaceCount count;
  for (const auto& [apart, i] : near) {
    const MapKeyframe& keyframe = database.keyframes[i];
    const Eigen::Isometry3d T_keyframe_camera = keyframe.T_world_camera.inverse() * T_world_camera;
    for (const PreviewOverlap& overlap :
         {compare_previews(frame, keyframe, T_keyframe_camera, kTolerance_m),
          compare_previews(keyframe, frame, T_keyframe_camera.inverse(), kTolerance_m)}) {
      count.same += overlap.same;
      count.through += overlap.through;
    }
  }
  return count;
}

bool is_same(const Eigen::Isometry3d& T_world_a, const Eigen::Isometry3d& T_world_b) {
  return is_near(T_world_a, T_world_b, kSamePose_m, kSamePose_rad);
}

/// Adds a pose unless it is that of the best or of another one.
void add_other(const Eigen::Isometry3d& T_world_other, const Eigen::Isometry3d& T_world_best,
               std::vector<Eigen::Isometry3d>& others) {
  const auto is_known = [&](const Eigen::Isometry3d& known) { return is_same(known, T_world_other); };
  if (!is_same(T_world_other, T_world_best) && std::none_of(others.begin(), others.end(), is_known))
    others.push_back(T_world_other);
}

/// Adds the poses that look like the best one by the database's look-alikes near it.
void add_look_alikes(const Eigen::Isometry3d& T_world_best, const KeyframeDatabase& database,
                     std::vector<Eigen::Isometry3d>& others) {
  constexpr double kNear_m = 2.5;  // less than the height of a storey
  std::vector<std::pair<double, const LookAlike*>> near;
  for (const LookAlike& look_alike : database.look_alikes) {
    const double distance_m = (look_alike.p_world - T_world_best.translation()).norm();
    if (distance_m < kNear_m) near.emplace_back(distance_m, &look_alike);
  }
  std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [distance_m, look_alike] : near)
    add_other(look_alike->T_other_this * T_world_best, T_world_best, others);
}

/// Removes the poses that keyframes contradict more than the best one.
void remove_contradicted(const MapKeyframe& frame, const Eigen::Isometry3d& T_world_best,
                         const KeyframeDatabase& database, std::vector<Eigen::Isometry3d>& others) {
  constexpr double kWorse = 0.03;
  constexpr int kEnough = 200;  // pixels
  if (others.empty()) return;
  const double agreement = count_surface(frame, T_world_best, database).agreement();
  std::erase_if(others, [&](const Eigen::Isometry3d& T_world_other) {
    const SurfaceCount there = count_surface(frame, T_world_other, database);
    return there.same + there.through >= kEnough && there.agreement() < agreement - kWorse;
  });
}

}  // namespace

std::string_view to_string(PlaceStatus status) {
  switch (status) {
    case PlaceStatus::kFound:
      return "found";
    case PlaceStatus::kNoKeyframes:
      return "no keyframes";
    case PlaceStatus::kNoDepth:
      return "no depth";
    case PlaceStatus::kNoColour:
      return "no colour";
    case PlaceStatus::kNoMatch:
      return "no match";
    case PlaceStatus::kNotVerified:
      return "not verified";
    case PlaceStatus::kAmbiguous:
      return "ambiguous";
  }
  return "unknown";
}

RecognisedPlace recognise_place(const Frame& frame, const KeyframeDatabase& keyframe_database,
                                const RelocaliseConfig& config) {
  RecognisedPlace place;
  const auto ended = [&place](PlaceStatus status) {
    place.status = status;
    return place;
  };
  if (keyframe_database.keyframes.empty()) return ended(PlaceStatus::kNoKeyframes);
  if (frame.colour.empty()) return ended(PlaceStatus::kNoColour);

  Query query;
  query.view = {.finest_width_px = config.place.preview_width_px, .normal_reach_px = 2};
  ViewPyramid pyramid;
  make_pyramid(frame.depth_m, frame.depth_camera, query.view, pyramid, frame.depth_noise);
  make_source_points(pyramid, query.points);
  if (query.points.levels.front().size() < kMinPoints) return ended(PlaceStatus::kNoDepth);
  KeyframeDatabaseConfig described = config.place;
  described.patches = 0;  // not used here
  query.features = make_map_keyframe(frame, Eigen::Isometry3d::Identity(), described);
  if (query.features.descriptors.size() < static_cast<std::size_t>(config.min_feature_inliers))
    return ended(PlaceStatus::kNoColour);

  bool was_matched = false;
  const std::vector<KeyframeWitness> witnesses =
      witnesses_of(query, keyframe_database, config, config.min_feature_inliers, {}, was_matched);
  if (witnesses.empty()) return ended(was_matched ? PlaceStatus::kNotVerified : PlaceStatus::kNoMatch);
  const KeyframeWitness& best = best_of(witnesses);
  place.keyframe = static_cast<std::int64_t>(best.keyframe);
  place.feature_inliers = best.feature_inliers;
  place.depth_agreement = best.proof.agreement;
  place.overlap = best.proof.overlap;

  const Eigen::Isometry3d T_world_best = pose_by(best, keyframe_database);
  const auto is_elsewhere = [&](std::size_t keyframe) {
    const Eigen::Vector3d& p_world = keyframe_database.keyframes[keyframe].T_world_camera.translation();
    return (p_world - T_world_best.translation()).norm() > kElsewhere_m;
  };
  const int min_rival_inliers =
      std::max(config.min_feature_inliers, static_cast<int>(kRivalPart * place.feature_inliers));
  bool ignored = false;
  const std::vector<KeyframeWitness> elsewhere =
      witnesses_of(query, keyframe_database, config, min_rival_inliers, is_elsewhere, ignored);
  place.T_world_camera = joint_pose(witnesses, best, query.points, keyframe_database);
  std::vector<Eigen::Isometry3d>& others = place.T_world_others;
  for (const auto* found : {&witnesses, &elsewhere})
    for (const KeyframeWitness& witness : *found) {
      const Eigen::Isometry3d T_world_other = pose_by(witness, keyframe_database);
      if (is_same(T_world_other, T_world_best)) continue;
      place.rival_inliers = std::max(place.rival_inliers, witness.feature_inliers);
      if (witness.feature_inliers >= kRivalPart * place.feature_inliers)
        add_other(T_world_other, T_world_best, others);
    }
  add_look_alikes(T_world_best, keyframe_database, others);
  remove_contradicted(query.features, T_world_best, keyframe_database, others);
  if (!others.empty()) return ended(PlaceStatus::kAmbiguous);
  return ended(PlaceStatus::kFound);
}

}  // namespace roomradar
