// odometry_snapshot.hpp: complete state of Odometry, taken after one frame and before the next, as plain
// data.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/odometry/keyframe_graph.hpp"
#include "mapping/odometry/keyframe_job.hpp"
#include "mapping/odometry/odometry_config.hpp"
#include "mapping/odometry/timing_estimate.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Frame with a pose relative to a keyframe. The frame moves with the keyframe.
struct KeptFrame {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  /// Index of the keyframe. Unset: T_keyframe_camera is the frame's pose in the world, and constant.
  std::optional<std::size_t> keyframe;
  Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
  TrackStatus status = TrackStatus::kDiverged;
  bool trusted = false;
};

struct OdometrySnapshot {
  OdometryCounts counts;
  KeyframeGraph graph;
  /// One entry per keyframe of `graph`. Entries added by Odometry::add_posed() have no keyframe in `graph`.
  KeyframeDatabase keyframe_database;
  std::vector<KeptFrame> frames;
  /// Index of the current keyframe: the keyframe with which the next frame is aligned first.
  std::size_t current = 0;
  /// Number of keyframes whose depth is final: frames no longer refine them.
  std::size_t final_keyframes = 0;
  /// Number of frames averaged into the current keyframe's depth since its points and normals were last
  /// recomputed.
  int improved = 0;
  Eigen::Isometry3d T_world_last = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_last_next = Eigen::Isometry3d::Identity();  ///< predicted motion to the next frame
  double path_length_m = 0.0;  ///< length of the camera's path; see Keyframe::path_length_m
  /// Intensity image of the last frame before the camera became stationary. Empty if that frame's pose is not
  /// trusted.
  Image<float> last_moved_grey;
  Tracking last_moved;   ///< tracking result of the frame of last_moved_grey
  bool located = false;  ///< true if poses are in the world of the prior map
  TimingEstimate timing;
};

/// Returns a frame's present pose in the world.
Eigen::Isometry3d T_world_camera_of(const OdometrySnapshot& kept, const KeptFrame& frame);

/// Returns the camera's mean velocity over the last 0.09 s or slightly more, or since the first frame if that
/// is later. Returns 0 if a frame in this time has no trusted pose, if the stamps do not increase, or if the
/// time is outside 1 ms to 0.2 s. The velocity between two consecutive frames is too noisy for correcting the
/// time of colour.
CameraVelocity mean_velocity(const OdometrySnapshot& kept, const Eigen::Isometry3d& T_world_now,
                             double now_s);

/// Prediction for a frame, from the motion between the two frames before it.
struct PredictedMotion {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  CameraVelocity velocity;
  double dt_s = 0.0;  ///< time since the last frame
};

/// Predicts that the camera continues at its velocity. If a time between these frames is outside 1 ms to 0.2
/// s, repeats the last motion and returns velocity 0.
PredictedMotion predict(const OdometrySnapshot& kept, double stamp_s);

/// Sets new poses of keyframes and moves all poses that depend on them. The camera pose moves with the
/// current keyframe.
/// @param moved  keyframes of kept.graph with new poses, in the same order; the newest keyframes may be
///               missing
/// @return the correction T_new_old = T_world_new * T_world_old^-1 of the current keyframe
Eigen::Isometry3d move_keyframes(const std::vector<Keyframe>& moved, OdometrySnapshot& kept);

/// Applies the background thread's result. Returns the correction of the current keyframe, as
/// move_keyframes() does. If the newest keyframe was localised in the prior map, adds an anchor for it. The
/// first anchor also moves all poses into the prior map's world.
Eigen::Isometry3d take_over(KeyframeJobResult result, OdometrySnapshot& kept);

/// Adds a frame with a given pose, and a keyframe to the database if the view is new.
void add_posed(OdometrySnapshot& kept, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
               const OdometryConfig& config);

/// Adds a frame whose pose is stored relative to the current keyframe.
void keep(OdometrySnapshot& kept, const Frame& frame, const Tracking& tracking);

/// Removes the frames from this index on, and the keyframes made of them with their constraints. The next
/// frame is then aligned with the keyframe of the last remaining frame. Depth of removed frames stays
/// averaged into older keyframes.
void forget_frames_from(std::int64_t frame_index, OdometrySnapshot& kept);

/// Returns all frames, with their present poses in the world.
std::vector<TrackedFrame> trajectory_of(const OdometrySnapshot& kept);

}  // namespace roomradar
