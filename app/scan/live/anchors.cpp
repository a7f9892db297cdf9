// anchors.cpp: places anchors along the camera's path.
#include "app/scan/live/anchors.hpp"

#include <limits>
#include <numbers>

namespace roomradar {
namespace {

constexpr double kReach_m = 0.8, kReach_rad = 40.0 * std::numbers::pi / 180.0;

Eigen::Isometry3d T_world_keyframe(const OdometrySnapshot& odometry, std::optional<std::size_t> keyframe) {
  return keyframe ? odometry.graph.keyframes[*keyframe].T_world_camera : Eigen::Isometry3d::Identity();
}

}  // namespace

bool correct(const OdometrySnapshot& odometry, Anchors& anchors) {
  constexpr double kMoved_m = 0.01, kAt_m = 2.0;
  bool is_moved = false;
  for (std::size_t i = 0; i < anchors.anchors.size(); ++i) {
    const Anchor& anchor = anchors.anchors[i];
    if (!anchors.T_world_anchor[i]) continue;
    if (anchor.keyframe && *anchor.keyframe >= odometry.graph.keyframes.size()) {  // tracking began again
      anchors.T_world_anchor[i].reset();
      is_moved = true;
      continue;
    }
    Eigen::Isometry3d& T_world_anchor = *anchors.T_world_anchor[i];
    const Eigen::Isometry3d now = T_world_keyframe(odometry, anchor.keyframe) * anchor.T_keyframe_anchor;
    const Eigen::Isometry3d change = T_world_anchor.inverse() * now;
    is_moved = is_moved || change.translation().norm() > kMoved_m ||
               kAt_m * Eigen::AngleAxisd(change.linear()).angle() > kMoved_m;
    T_world_anchor = now;
  }
  return is_moved;
}

std::size_t anchor_for(std::int64_t frame_index, const Eigen::Isometry3d& T_world_camera,
                       const OdometrySnapshot& odometry, Anchors& anchors) {
  std::size_t best = anchors.anchors.size();
  double least = 1.0;
  for (std::size_t i = 0; i < anchors.anchors.size(); ++i) {
    if (!anchors.T_world_anchor[i]) continue;
    const Eigen::Isometry3d apart =
        (*anchors.T_world_anchor[i] * anchors.anchors[i].T_anchor_camera).inverse() * T_world_camera;
    const double distance = std::max(apart.translation().norm() / kReach_m,
                                     Eigen::AngleAxisd(apart.linear()).angle() / kReach_rad);
    if (distance >= least) continue;
    least = distance;
    best = i;
  }
  if (best < anchors.anchors.size()) {
    anchors.anchors[best].last_frame = frame_index;
    return best;
  }
  const bool has_keyframe = !odometry.graph.keyframes.empty();
  Anchor made;
  if (has_keyframe) made.keyframe = odometry.current;
  made.last_frame = frame_index;
  const Eigen::Isometry3d T_world_anchor(Eigen::Translation3d(T_world_camera.translation()));
  made.T_keyframe_anchor = T_world_keyframe(odometry, made.keyframe).inverse() * T_world_anchor;
  made.T_anchor_camera = T_world_anchor.inverse() * T_world_camera;
  anchors.anchors.push_back(made);
  anchors.T_world_anchor.emplace_back(T_world_anchor);
  return best;
}

void forget_frames_from(std::int64_t frame_index, Anchors& anchors) {
  for (std::size_t i = 0; i < anchors.anchors.size(); ++i)
    if (anchors.anchors[i].last_frame >= frame_index) anchors.T_world_anchor[i].reset();
}

}  // namespace roomradar
