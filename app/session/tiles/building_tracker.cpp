// building_tracker.cpp: tracking by locate(), search by recognise_place().
#include "app/session/tiles/building_tracker.hpp"

namespace roomradar {
namespace {

/// Aligns the frame with the loaded surface, from a recognised pose. Returns no pose if the depth contradicts
/// that pose.
Tracking begin_at(Locator& locator, const Frame& frame, const Eigen::Isometry3d& T_world_place,
                  const ExpectedDepth& expected_depth) {
  constexpr double kMaxShift_m = 0.15, kMaxShift_rad = 0.1;
  constexpr double kMinAlike = 0.5, kMaxFarther = 0.15, kMinCovered = 0.2;
  locator.T_world_camera = T_world_place;
  locator.T_last_now.setIdentity();
  const Tracking tracking = locate(locator, frame, KeyframeDatabase{}, {}, expected_depth);
  if (has_pose(tracking)) {
    const DepthAgreement agreement =
        depth_agreement_of(frame.depth_m, expected_depth(tracking.T_world_camera));
    if (is_near(tracking.T_world_camera, T_world_place, kMaxShift_m, kMaxShift_rad) &&
        agreement.both > kMinCovered * agreement.valid && agreement.alike_part() > kMinAlike &&
        agreement.farther_part() < kMaxFarther)
      return tracking;
  }
  locator.T_world_camera.reset();
  locator.T_world_lost.reset();
  return {};
}

/// Returns true for some of the frames whose depth contradicts the tracked pose.
bool is_recheck_due(const Locator& locator) {
  constexpr int kPatience_frames = 3, kEvery_frames = 10;
  return locator.unverified_frames % kEvery_frames == kPatience_frames;
}

}  // namespace

Tracking BuildingTracker::locate(Locator& locator, const Frame& frame,
                                 const KeyframeDatabase& keyframe_database, const MaskImage& dynamic_mask,
                                 const ExpectedDepth& expected_depth) {
  constexpr double kElsewhere_m = 0.5, kElsewhere_rad = 0.5;  // then the tracked pose is wrong
  // Without keyframes, the camera is followed, also after a short loss, but not searched.
  Tracking tracking = roomradar::locate(locator, frame, KeyframeDatabase{}, dynamic_mask, expected_depth);
  if (!has_pose(tracking) || is_recheck_due(locator)) {
    const RecognisedPlace place = recognise_place(frame, keyframe_database, locator.relocalise);
    if (place.status == PlaceStatus::kAmbiguous) ++ambiguous_;
    if (place) ++recognised_;
    const bool is_elsewhere =
        place && !(has_pose(tracking) &&
                   is_near(place.T_world_camera, tracking.T_world_camera, kElsewhere_m, kElsewhere_rad));
    if (is_elsewhere) {
      const Eigen::Vector3d& p_world = place.T_world_camera.translation();
      locator.T_world_camera.reset();
      locator.unverified_frames = 0;
      tracking = tiles_.is_ready_at(p_world) ? begin_at(locator, frame, place.T_world_camera, expected_depth)
                                             : Tracking{};
      if (!has_pose(tracking)) tiles_.follow(p_world);
    }
  }
  if (has_pose(tracking)) tiles_.follow(tracking.T_world_camera.translation());
  return tracking;
}

}  // namespace roomradar
