// odometry_config.hpp: settings and counts of an odometry, and the pose of one frame of its trajectory.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/odometry/keyframe_graph.hpp"

namespace roomradar {

struct OdometryConfig {
  ViewConfig view;
  /// Settings for aligning frames with keyframes. Intensity has less weight than its noise justifies, since
  /// the calibration of the colour camera is inexact and walls are glossy.
  AlignConfig align = {.intensity_sigma = 16.0F, .max_correction_m = 0.25F, .max_correction_rad = 0.25F};
  /// Settings for aligning keyframes with each other. Keyframes are farther apart than consecutive frames, so
  /// the distortion of depth matters. A wide robust kernel averages the distortion out. robust_sigma and the
  /// intensity_sigma of both AlignConfigs were chosen on the kitchen recording. Each changes the absolute
  /// trajectory error and the relative pose error over 30 frames by at most 0.3 mm.
  AlignConfig align_keyframes = {
      .robust_sigma = 4.0F, .intensity_sigma = 8.0F, .max_correction_m = 0.25F, .max_correction_rad = 0.25F};
  KeyframeGraphConfig graph;
  KeyframeDatabaseConfig place;
  RelocaliseConfig relocalise;
  /// A frame becomes a keyframe if each existing keyframe is farther away than keyframe_distance_m or rotated
  /// by more than keyframe_angle_deg.
  double keyframe_distance_m = 0.10;
  double keyframe_angle_deg = 8.0;
  /// Min overlap with the current keyframe. Below it, another keyframe becomes the current one, or a keyframe
  /// is added.
  double keyframe_overlap = 0.7;
  /// Use recorded poses as a prior on the motion, see MotionPrior.
  bool use_recorded_poses = false;
  int references = 2;  ///< max number of keyframes that a frame is aligned with
  /// Number of frames averaged into a keyframe's depth before its points and normals are recomputed.
  int improve_every = 5;
  /// Number of frames after which the background thread's result for a new keyframe is applied.
  int apply_result_after_frames = 4;
  /// Initial readout times and colour delay. Unset: the values of the first frame.
  std::optional<SensorTiming> timing;
  bool estimate_timing = true;  ///< correct the times while tracking
};

/// Pose of one frame of the trajectory.
struct TrackedFrame {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  TrackStatus status = TrackStatus::kDiverged;
  int part = 0;          ///< see Keyframe::part; poses of different parts have no known relation
  bool trusted = false;  ///< true if the pose is accurate enough to fuse the frame's depth into the map
};

struct OdometryCounts {
  std::int64_t frames = 0;
  std::int64_t tracked = 0;      ///< number of frames with a trusted pose
  std::int64_t degenerate = 0;   ///< number of frames whose pose has an unconstrained direction
  std::int64_t lost = 0;         ///< number of frames without a pose
  std::int64_t relocalised = 0;  ///< number of recoveries from a loss by place recognition
  std::int64_t keyframes = 0;
  std::int64_t loops_found = 0;  ///< see KeyframeGraph
  /// Number of loop candidates that could not be connected; see join().
  std::int64_t loops_rejected = 0;
  std::int64_t anchored = 0;  ///< number of keyframes localised in the prior map
};

}  // namespace roomradar
