// odometry_snapshot.cpp: moves keyframes and the poses that depend on them, and predicts motion.
#include "mapping/odometry/odometry_snapshot.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

void anchor(std::size_t keyframe, const Eigen::Isometry3d& T_known_camera, OdometrySnapshot& kept) {
  // Standard deviations of a relocalised pose. Its error is nearer to 0.02 m, but is common to keyframes that
  // show the same moved furniture, while the alignments between keyframes are accurate.
  constexpr double kSigma_m = 0.1, kSigma_rad = 0.05;
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(1.0 / (kSigma_m * kSigma_m));
  information.diagonal().tail<3>().setConstant(1.0 / (kSigma_rad * kSigma_rad));
  kept.graph.anchors.push_back({keyframe, T_known_camera, information});
  ++kept.counts.anchored;
}

/// Returns the transform on which most anchors of a part agree, from the part's present world frame to the
/// known map's. Returns identity if no other transform has more anchors. A view of furniture alone is
/// recognised where the furniture stood, so a single anchor may be wrong.
Eigen::Isometry3d agreed_transform(const OdometrySnapshot& kept, int part) {
  std::vector<std::pair<const PoseAnchor*, const Keyframe*>> anchored;
  for (const PoseAnchor& anchor : kept.graph.anchors)
    if (const Keyframe& keyframe = kept.graph.keyframes[anchor.pose]; keyframe.part == part)
      anchored.emplace_back(&anchor, &keyframe);
  const auto count_agreeing = [&](const Eigen::Isometry3d& T_known_world) {
    return std::count_if(anchored.begin(), anchored.end(),
                         [&](const auto& of) { return agrees(*of.first, *of.second, T_known_world); });
  };
  Eigen::Isometry3d best = Eigen::Isometry3d::Identity();
  auto most = kept.located ? count_agreeing(best) : 0;
  for (const auto& [anchor, keyframe] : anchored) {
    const Eigen::Isometry3d T_known_world = anchor->T_world_camera * keyframe->T_world_camera.inverse();
    const auto agreeing = count_agreeing(T_known_world);
    if (agreeing <= most) continue;
    most = agreeing;
    best = T_known_world;
  }
  return best;
}

}  // namespace

Eigen::Isometry3d move_keyframes(const std::vector<Keyframe>& moved, OdometrySnapshot& kept) {
  const Eigen::Isometry3d before = kept.graph.keyframes[kept.current].T_world_camera;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    kept.graph.keyframes[i].T_world_camera = moved[i].T_world_camera;
    if (i < kept.keyframe_database.keyframes.size())
      kept.keyframe_database.keyframes[i].T_world_camera = moved[i].T_world_camera;
  }
  const Eigen::Isometry3d T_new_old = kept.graph.keyframes[kept.current].T_world_camera * before.inverse();
  kept.T_world_last = T_new_old * kept.T_world_last;
  kept.last_moved.T_world_camera = T_new_old * kept.last_moved.T_world_camera;
  if (kept.prior.T_world_recorded) kept.prior.T_world_recorded = T_new_old * *kept.prior.T_world_recorded;
  return T_new_old;
}

Eigen::Isometry3d take_over(KeyframeJobResult result, OdometrySnapshot& kept) {
  const std::size_t newest = result.graph.keyframes.size() - 1;
  kept.graph.constraints = std::move(result.graph.constraints);
  kept.graph.loops_found = result.graph.loops_found;
  kept.graph.loops_rejected = result.graph.loops_rejected;
  kept.keyframe_database.keyframes.push_back(std::move(result.place));
  Eigen::Isometry3d T_new_old = move_keyframes(result.graph.keyframes, kept);
  if (result.T_known_camera) {
    anchor(newest, *result.T_known_camera, kept);
    const int part = kept.graph.keyframes[newest].part;
    const Eigen::Isometry3d T_known_world = agreed_transform(kept, part);
    std::vector<Keyframe> moved = kept.graph.keyframes;
    for (Keyframe& keyframe : moved)
      if (!kept.located || keyframe.part == part)
        keyframe.T_world_camera = T_known_world * keyframe.T_world_camera;
    T_new_old = move_keyframes(moved, kept) * T_new_old;
    kept.located = true;
  }
  return T_new_old;
}

Eigen::Isometry3d T_world_camera_of(const OdometrySnapshot& kept, const KeptFrame& frame) {
  return frame.keyframe ? kept.graph.keyframes[*frame.keyframe].T_world_camera * frame.T_keyframe_camera
                        : frame.T_keyframe_camera;
}

CameraVelocity mean_velocity(const OdometrySnapshot& kept, const Eigen::Isometry3d& T_world_now,
                             double now_s) {
  constexpr double kSpan_s = 0.09;
  for (std::size_t i = kept.frames.size(); i-- > 0;) {
    const KeptFrame& frame = kept.frames[i];
    if (!frame.trusted || !(frame.stamp_s < now_s)) return {};
    if (now_s - frame.stamp_s >= kSpan_s || i == 0)
      return velocity_of(T_world_camera_of(kept, frame).inverse() * T_world_now, now_s - frame.stamp_s);
  }
  return {};
}

PredictedMotion predict(const OdometrySnapshot& kept, double stamp_s) {
  const std::size_t count = kept.frames.size();
  PredictedMotion predicted;
  predicted.T_world_camera = kept.T_world_last * kept.T_last_next;
  if (count < 1) return predicted;
  predicted.dt_s = stamp_s - kept.frames[count - 1].stamp_s;
  if (count < 2) return predicted;
  const double before_s = kept.frames[count - 1].stamp_s - kept.frames[count - 2].stamp_s;
  if (!gives_velocity(before_s) || !gives_velocity(predicted.dt_s)) return predicted;
  predicted.T_world_camera = kept.T_world_last * retract(predicted.dt_s / before_s * local(kept.T_last_next));
  predicted.velocity = mean_velocity(kept, predicted.T_world_camera, stamp_s);
  return predicted;
}

void add_posed(OdometrySnapshot& kept, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
               const OdometryConfig& config) {
  std::vector<MapKeyframe>& keyframe_database = kept.keyframe_database.keyframes;
  ++kept.counts.frames;
  ++kept.counts.tracked;
  kept.frames.push_back(
      {frame.index, frame.stamp_s, std::nullopt, T_world_camera, TrackStatus::kTracked, true});
  const double limit = view_distance(
      Eigen::Translation3d(config.keyframe_distance_m, 0, 0) *
      Eigen::AngleAxisd(config.keyframe_angle_deg * std::numbers::pi / 180.0, Eigen::Vector3d::UnitX()));
  const bool known =
      std::any_of(keyframe_database.begin(), keyframe_database.end(), [&](const MapKeyframe& place) {
        return view_distance(place.T_world_camera.inverse() * T_world_camera) < limit;
      });
  if (known) return;
  keyframe_database.push_back(make_map_keyframe(frame, T_world_camera, config.place));
  ++kept.counts.keyframes;
}

void keep(OdometrySnapshot& kept, const Frame& frame, const Tracking& tracking) {
  KeptFrame frame_kept{frame.index,     frame.stamp_s, std::nullopt, tracking.T_world_camera,
                       tracking.status, bool{tracking}};
  if (!kept.graph.keyframes.empty()) {
    frame_kept.keyframe = kept.current;
    frame_kept.T_keyframe_camera =
        kept.graph.keyframes[kept.current].T_world_camera.inverse() * tracking.T_world_camera;
  }
  kept.frames.push_back(frame_kept);
}

void forget_frames_from(std::int64_t frame_index, OdometrySnapshot& kept) {
  std::erase_if(kept.frames, [&](const KeptFrame& frame) { return frame.frame_index >= frame_index; });
  KeyframeGraph& graph = kept.graph;
  std::erase_if(graph.keyframes,
                [&](const Keyframe& keyframe) { return keyframe.frame_index >= frame_index; });
  std::erase_if(kept.keyframe_database.keyframes,
                [&](const MapKeyframe& keyframe) { return keyframe.frame_index >= frame_index; });
  kept.keyframe_database.index = {};
  if (kept.frames.empty() || (graph.keyframes.empty() && kept.keyframe_database.keyframes.empty())) {
    kept = {};
    return;
  }
  const std::size_t left = graph.keyframes.size();
  std::erase_if(graph.constraints, [&](const PoseConstraint& constraint) {
    return constraint.a >= left || constraint.b >= left;
  });
  std::erase_if(graph.anchors, [&](const PoseAnchor& anchor) { return anchor.pose >= left; });
  kept.counts.keyframes = std::ssize(kept.keyframe_database.keyframes);
  kept.final_keyframes = std::min(kept.final_keyframes, left);
  const KeptFrame& last = kept.frames.back();
  kept.current = last.keyframe.value_or(0);
  kept.improved = 0;
  kept.T_world_last = T_world_camera_of(kept, last);
  kept.T_last_next.setIdentity();
  kept.last_moved_grey.resize(0, 0);
  interrupt_prior(kept.prior);
  kept.lost.reset();
}

std::vector<TrackedFrame> trajectory_of(const OdometrySnapshot& kept) {
  std::vector<TrackedFrame> trajectory;
  for (const KeptFrame& f : kept.frames) {
    const int part = f.keyframe ? kept.graph.keyframes[*f.keyframe].part : 0;
    trajectory.push_back({f.frame_index, f.stamp_s, T_world_camera_of(kept, f), f.status, part, f.trusted});
  }
  return trajectory;
}

}  // namespace roomradar
