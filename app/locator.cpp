// locator.cpp: alignment with the static model, relocalisation when that fails.
#include "app/locator.hpp"

#include <cmath>

namespace roomradar {
namespace {

bool is_located(const Tracking& tracking) {
  return tracking.status == TrackStatus::kTracked || tracking.status == TrackStatus::kDegenerate;
}

/// Of the pixels that both have, the part at which live and expected depth are the same surface: apart by no
/// more than noise, a distorted map, or a sensor that was recalibrated make them.
double agreement(const DepthImage& depth_m, const DepthImage& expected_m) {
  constexpr int kStep_px = 4;
  constexpr float kAlike_per_m = 0.02F;  // of inverse depth; 5 steps of a Kinect's disparity are 0.014
  int alike = 0, both = 0;
  for (int y = 0; y < depth_m.height; y += kStep_px) {
    for (int x = 0; x < depth_m.width; x += kStep_px) {
      const float live = depth_m.at(x, y), expected = expected_m.at(x, y);
      if (!(live > 0.0F && expected > 0.0F)) continue;
      ++both;
      alike += std::abs(live - expected) < kAlike_per_m * live * expected;
    }
  }
  return both > 0 ? static_cast<double>(alike) / both : 0.0;
}

/// A Kinect that recalibrates itself bends its depth from one frame to the next, and alignment takes that for
/// a motion, by which edges come to stand where they are not seen. So a motion that nothing announced has to
/// explain no fewer pixels than a camera that stood still would.
bool is_bend_not_motion(const Tracking& tracking, const Eigen::Isometry3d& T_world_predicted,
                        const Eigen::Isometry3d& T_world_before, const DepthImage& depth_m,
                        const ExpectedDepth& expected_depth) {
  constexpr double kSudden_m = 0.03, kSudden_rad = 0.01;
  constexpr double kMoreExplained = 0.005;
  const Eigen::Isometry3d T_predicted_camera = T_world_predicted.inverse() * tracking.T_world_camera;
  const double turned_rad = Eigen::AngleAxisd(T_predicted_camera.linear()).angle();
  if (T_predicted_camera.translation().norm() < kSudden_m && turned_rad < kSudden_rad) return false;
  const double by_motion = agreement(depth_m, expected_depth(tracking.T_world_camera));
  return agreement(depth_m, expected_depth(T_world_before)) > by_motion + kMoreExplained;
}

/// Aligns the live view with the model as seen from the guess; twice where the guess was far off, for then
/// the model showed other surfaces than the camera sees.
Tracking align_with_model(Locator& locator, const Intrinsics& camera,
                          const Eigen::Isometry3d& T_world_camera_guess,
                          const ExpectedDepth& expected_depth) {
  constexpr double kFarOff_m = 0.05;
  constexpr double kFarOff_rad = 0.05;
  Tracking tracking;
  tracking.T_world_camera = T_world_camera_guess;
  for (int round = 0; round < 2; ++round) {
    const Eigen::Isometry3d T_world_view = tracking.T_world_camera;
    make_pyramid(expected_depth(T_world_view), camera, locator.expected_view, locator.expected_pyramid);
    make_reference(locator.expected_pyramid, T_world_view, locator.expected_view, locator.expected);
    tracking = align(locator.live, locator.expected, T_world_view, locator.align);
    const Eigen::Isometry3d T_view_camera = T_world_view.inverse() * tracking.T_world_camera;
    const double turned_rad = Eigen::AngleAxisd(T_view_camera.linear()).angle();
    if (!is_located(tracking) || (T_view_camera.translation().norm() < kFarOff_m && turned_rad < kFarOff_rad))
      break;
  }
  return tracking;
}

}  // namespace

Tracking locate(Locator& locator, const Frame& frame, const Places& places, const MaskImage& moved_mask,
                const ExpectedDepth& expected_depth) {
  make_pyramid(frame, locator.live_view, locator.live_pyramid);
  make_live(locator.live_pyramid, locator.live, moved_mask);

  Tracking tracking;
  if (locator.T_world_camera) {
    const Eigen::Isometry3d predicted = *locator.T_world_camera * locator.T_last_now;
    tracking = align_with_model(locator, frame.depth_camera, predicted, expected_depth);
    if (is_located(tracking) &&
        is_bend_not_motion(tracking, predicted, *locator.T_world_camera, frame.depth_m, expected_depth)) {
      tracking.status = TrackStatus::kDegenerate;
      tracking.T_world_camera = *locator.T_world_camera;
    }
  }
  if (!is_located(tracking)) {
    make_live(locator.live_pyramid, locator.live);  // the mask belonged to a pose that no longer holds
    const Relocalisation found = relocalise(frame, places, locator.relocalise);
    if (found) tracking = align_with_model(locator, frame.depth_camera, found.T_world_camera, expected_depth);
    locator.T_world_camera.reset();
  }

  if (!is_located(tracking)) {
    locator.T_last_now.setIdentity();
    return tracking;
  }
  locator.T_last_now = locator.T_world_camera
                           ? Eigen::Isometry3d(locator.T_world_camera->inverse() * tracking.T_world_camera)
                           : Eigen::Isometry3d::Identity();
  locator.T_world_camera = tracking.T_world_camera;
  return tracking;
}

}  // namespace roomradar
