// recognise_place.cpp: candidates by features, proofs by depth, then a search for rivals elsewhere.
#include "mapping/localization/recognise_place.hpp"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "mapping/alignment/keyframe.hpp"
#include "mapping/localization/keyframe_proof.hpp"
#include "mapping/localization/place_matching.hpp"
#include "mapping/localization/pose_hypothesis.hpp"
#include "mapping/localization/preview_overlap.hpp"

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

/// Returns the poses that look like this one by the database's look-alikes near it.
std::vector<Eigen::Isometry3d> look_alikes_of(const Eigen::Isometry3d& T_world_camera,
                                              const KeyframeDatabase& database) {
  constexpr double kNear_m = 2.5;  // less than the height of a storey
  std::vector<std::pair<double, const LookAlike*>> near;
  for (const LookAlike& look_alike : database.look_alikes) {
    const double distance_m = (look_alike.p_world - T_world_camera.translation()).norm();
    if (distance_m < kNear_m) near.emplace_back(distance_m, &look_alike);
  }
  std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::Isometry3d> poses;
  for (const auto& [distance_m, look_alike] : near) {
    const Eigen::Isometry3d T = look_alike->T_other_this * T_world_camera;
    const auto is_same = [&](const Eigen::Isometry3d& other) {
      return is_near(other, T, kSamePose_m, kSamePose_rad);
    };
    if (std::none_of(poses.begin(), poses.end(), is_same)) poses.push_back(T);
  }
  return poses;
}

/// Returns whether the frame may be from a place that looks like that of its pose: nothing that was recorded
/// there contradicts it more than what was recorded at the pose itself.
bool may_be_look_alike(const MapKeyframe& frame, const Eigen::Isometry3d& T_world_camera,
                       const KeyframeDatabase& database) {
  constexpr double kWorse = 0.03;
  constexpr int kEnough = 200;  // pixels
  const std::vector<Eigen::Isometry3d> others = look_alikes_of(T_world_camera, database);
  if (others.empty()) return false;
  const double agreement = count_surface(frame, T_world_camera, database).agreement();
  return std::any_of(others.begin(), others.end(), [&](const Eigen::Isometry3d& T_world_other) {
    const SurfaceCount there = count_surface(frame, T_world_other, database);
    return there.same + there.through < kEnough || there.agreement() > agreement - kWorse;
  });
}

/// Returns the most inliers of a witness whose pose is another one; 0 if there is none.
int rival_inliers(const std::vector<KeyframeWitness>& witnesses, const Eigen::Isometry3d& T_world_camera,
                  const KeyframeDatabase& database) {
  int most = 0;
  for (const KeyframeWitness& witness : witnesses)
    if (!is_near(pose_by(witness, database), T_world_camera, kSamePose_m, kSamePose_rad))
      most = std::max(most, witness.feature_inliers);
  return most;
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
  place.rival_inliers = std::max(rival_inliers(witnesses, T_world_best, keyframe_database),
                                 rival_inliers(elsewhere, T_world_best, keyframe_database));
  if (place.rival_inliers >= kRivalPart * place.feature_inliers) return ended(PlaceStatus::kAmbiguous);
  if (may_be_look_alike(query.features, T_world_best, keyframe_database))
    return ended(PlaceStatus::kAmbiguous);
  place.T_world_camera = joint_pose(witnesses, best, query.points, keyframe_database);
  return ended(PlaceStatus::kFound);
}

}  // namespace roomradar
