// odometry_snapshot.hpp: state of Odometry between two frames, without the prior map, as plain data.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/alignment/motion_prior.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/odometry/keyframe_graph.hpp"
#include "mapping/odometry/keyframe_job.hpp"
#include "mapping/odometry/odometry_config.hpp"
#include "mapping/odometry/timing_estimate.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Frame with a pose relative to a keyframe. When the keyframe is moved, the frame's world pose changes, too.
struct KeptFrame {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  /// Index of the keyframe. Unset: T_keyframe_camera is the frame's constant pose in the world frame.
  std::optional<std::size_t> keyframe;
  Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
  TrackStatus status = TrackStatus::kDiverged;
  bool trusted = false;
};

/// Where tracking was lost before the current part began.
struct LostPlace {
  std::size_t keyframe = 0;
  Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
  double stamp_s = 0.0;
};

struct OdometrySnapshot {
  OdometryCounts counts;
  KeyframeGraph graph;
  /// One entry per keyframe of `graph`, in the same order. In Odometry::state(), the newest keyframe's entry
  /// may be missing: the background thread's result adds it. Odometry::add_posed() adds entries without
  /// keyframes; `graph` is then empty.
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
  /// Intensity image of the last tracked frame in which the camera was not judged stationary. A lost frame
  /// leaves it unchanged; a frame with a degenerate pose empties it.
  Image<float> last_moved_grey;
  bool is_stationary = false;  ///< the last frame's camera was judged stationary
  Tracking last_moved;         ///< tracking result of the frame of last_moved_grey
  int parts = 1;               ///< number of parts, see Keyframe::part
  /// Set for 1 s after a loss: frames of the new part are also tried at this place.
  std::optional<LostPlace> lost;
  MotionPrior prior;     ///< recorded poses; used with OdometryConfig::use_recorded_poses
  bool located = false;  ///< true if poses are in the prior map's world frame
  TimingEstimate timing;
};

/// Returns a frame's present pose in the world frame.
Eigen::Isometry3d T_world_camera_of(const OdometrySnapshot& kept, const KeptFrame& frame);

/// Returns the camera's mean velocity over 0.09 s or slightly more, up to now_s; over less time if the
/// recording began later. Returns 0 if a frame in this time has no trusted pose, if the stamps do not
/// increase, or if the time is outside 1 ms to 0.2 s. A velocity from two consecutive frames would be too
/// noisy to compensate the colour delay.
CameraVelocity mean_velocity(const OdometrySnapshot& kept, const Eigen::Isometry3d& T_world_now,
                             double now_s);

/// Prediction for a frame, from the motion between the two preceding frames.
struct PredictedMotion {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  CameraVelocity velocity;
  double dt_s = 0.0;  ///< time since the last frame
};

/// Predicts the pose with constant velocity. If the interval between the last two frames, or from the last
/// frame to stamp_s, is outside 1 ms to 0.2 s, repeats the last motion and returns velocity 0.
PredictedMotion predict(const OdometrySnapshot& kept, double stamp_s);

/// Sets new poses of keyframes and moves all poses that depend on them. The camera pose moves with the
/// current keyframe.
/// @param moved  keyframes of kept.graph with new poses, in the same order; the newest keyframes may be
///               missing
/// @return correction T_new_old of the current keyframe: its new world pose times the inverse of its old one
Eigen::Isometry3d move_keyframes(const std::vector<Keyframe>& moved, OdometrySnapshot& kept);

/// Applies the background thread's result. Returns the correction of the current keyframe, as
/// move_keyframes() does. If the newest keyframe was localised in the prior map, adds an anchor for it, and
/// moves all poses to where most anchors agree: the first one into the prior map's world frame.
Eigen::Isometry3d take_over(KeyframeJobResult result, OdometrySnapshot& kept);

/// Adds a frame with a given pose; see Odometry::add_posed().
void add_posed(OdometrySnapshot& kept, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
               const OdometryConfig& config);

/// Adds a frame. Stores its pose relative to the current keyframe; in the world frame if there is no
/// keyframe.
void keep(OdometrySnapshot& kept, const Frame& frame, const Tracking& tracking);

/// Removes the frames from frame_index on, the keyframes made from them, and these keyframes' constraints,
/// anchors and database entries. The next frame is then aligned with the keyframe of the last remaining
/// frame. Depth of removed frames stays averaged into older keyframes.
void forget_frames_from(std::int64_t frame_index, OdometrySnapshot& kept);

/// Returns all frames, with their present poses in the world frame.
std::vector<TrackedFrame> trajectory_of(const OdometrySnapshot& kept);

}  // namespace roomradar
