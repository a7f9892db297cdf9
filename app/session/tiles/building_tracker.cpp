// building_tracker.cpp: tracking by locate(), search by recognise_place().
#include "app/session/tiles/building_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

/// Makes the camera lost, without an attempt to resume at its last pose.
void forget_pose(Locator& locator) {
  locator.T_world_camera.reset();
  locator.T_world_lost.reset();
  locator.T_last_now.setIdentity();
  locator.unverified_frames = locator.recheck_cooldown_frames = 0;
}

/// Aligns the frame with the loaded surface, from a recognised pose. Returns no pose if the depth contradicts
/// that pose.
Tracking begin_at(Locator& locator, const Frame& frame, const Eigen::Isometry3d& T_world_place,
                  const ExpectedDepth& expected_depth) {
  constexpr double kMaxShift_m = 0.15, kMaxShift_rad = 0.1;
  constexpr double kMinAlike = 0.5, kMaxFarther = 0.15, kMinCovered = 0.2;
  constexpr double kMinAlikeOpen = 0.95, kMaxFartherOpen = 0.02;  // of a pose that depth does not constrain
  locator.T_world_camera = T_world_place;
  locator.T_last_now.setIdentity();
  const Tracking tracking = locate(locator, frame, KeyframeDatabase{}, {}, expected_depth);
  if (has_pose(tracking)) {
    const DepthAgreement agreement =
        depth_agreement_of(frame.depth_m, expected_depth(tracking.T_world_camera));
    const bool is_open = tracking.status == TrackStatus::kDegenerate;
    if (is_near(tracking.T_world_camera, T_world_place, kMaxShift_m, kMaxShift_rad) &&
        agreement.both > kMinCovered * agreement.valid &&
        agreement.alike_part() > (is_open ? kMinAlikeOpen : kMinAlike) &&
        agreement.farther_part() < (is_open ? kMaxFartherOpen : kMaxFarther))
      return tracking;
  }
  forget_pose(locator);
  return {};
}

}  // namespace

bool BuildingTracker::judge(const Frame& frame, const Tracking& tracking, const DepthImage& expected_m) {
  // A hand in front of the camera covers less than half of the image, and nothing is seen through a surface.
  constexpr double kMaxFarther = 0.05, kMinAlike = 0.5, kRefutedFarther = 0.1, kRefutedAlike = 0.4;
  constexpr double kMinCovered = 0.3;
  const DepthAgreement agreement = depth_agreement_of(frame.depth_m, expected_m);
  const double farther = agreement.farther_part(), alike = agreement.alike_part();
  is_contradicted_ = farther > kMaxFarther || alike < kMinAlike;
  is_refuted_ = farther > kRefutedFarther || alike < kRefutedAlike;
  const bool is_supported =
      tracking.status == TrackStatus::kTracked && agreement.both >= kMinCovered * agreement.valid;
  if (is_supported) supported_s_ = frame.stamp_s;
  doubtful_frames_ = is_contradicted_ || !is_supported ? doubtful_frames_ + 1 : 0;
  return is_supported;
}

bool BuildingTracker::is_support_outdated(double stamp_s) const {
  constexpr double kMaxFollowed_s = 0.15;  // 0.15 m at a quick walk
  return !supported_s_ || !(std::abs(stamp_s - *supported_s_) <= kMaxFollowed_s);
}

bool BuildingTracker::is_recheck_due() const {
  constexpr int kPatience_frames = 3, kEvery_frames = 5;
  return (doubtful_frames_ == 1 && is_contradicted_) || doubtful_frames_ % kEvery_frames == kPatience_frames;
}

Tracking BuildingTracker::locate(Locator& locator, const Frame& frame,
                                 const KeyframeDatabase& keyframe_database, const MaskImage& dynamic_mask,
                                 const ExpectedDepth& expected_depth) {
  // A pose farther than this from the place that the frame shows is wrong. One without support is replaced
  // much earlier.
  constexpr double kElsewhere_m = 0.25, kElsewhere_rad = 0.15, kSlipped_m = 0.05, kSlipped_rad = 0.03;
  // Without keyframes, the camera is followed, also after a short loss, but not searched.
  Tracking tracking = roomradar::locate(locator, frame, KeyframeDatabase{}, dynamic_mask, expected_depth);
  const bool is_supported =
      has_pose(tracking) && judge(frame, tracking, expected_depth(tracking.T_world_camera));
  const bool is_unsupported = has_pose(tracking) && is_support_outdated(frame.stamp_s);
  const std::optional<Eigen::Isometry3d> T_world_last_place = std::exchange(T_world_place_, std::nullopt);
  if (!has_pose(tracking) || is_unsupported || is_recheck_due()) {
    const RecognisedPlace place = recognise_place(frame, keyframe_database, locator.relocalise);
    if (place.status == PlaceStatus::kAmbiguous) ++ambiguous_;
    if (place) ++recognised_;
    const auto is_tracked = [&](const Eigen::Isometry3d& T_world_camera) {
      return is_near(T_world_camera, tracking.T_world_camera, is_supported ? kElsewhere_m : kSlipped_m,
                     is_supported ? kElsewhere_rad : kSlipped_rad);
    };
    // Of places that look alike, the tracked one stays.
    const bool is_seen = place || place.status == PlaceStatus::kAmbiguous;
    const bool is_same = has_pose(tracking) && is_seen &&
                         (is_tracked(place.T_world_camera) ||
                          std::any_of(place.T_world_others.begin(), place.T_world_others.end(), is_tracked));
    if (is_same) supported_s_ = frame.stamp_s;
    if (has_pose(tracking) && !is_same && (place || is_refuted_ || is_unsupported)) {
      tracking = {};
      forget_pose(locator);
    }
    if (place && !has_pose(tracking)) {
      T_world_place_ = place.T_world_camera;
      doubtful_frames_ = 0;
      if (tiles_.is_ready_for(frame, place.T_world_camera))
        tracking = begin_at(locator, frame, place.T_world_camera, expected_depth);
      if (has_pose(tracking)) supported_s_ = frame.stamp_s;
      if (has_pose(tracking) && T_world_last_place)
        locator.T_last_now = T_world_last_place->inverse() * tracking.T_world_camera;
    }
  }
  if (has_pose(tracking))
    tiles_.follow(frame, tracking.T_world_camera);
  else if (T_world_place_)
    tiles_.follow(frame, *T_world_place_);
  else if (has_guess(tracking))
    tiles_.follow(frame, tracking.T_world_camera);
  return tracking;
}

}  // namespace roomradar
