// odometry_config.hpp: settings of an odometry, its counts, and an entry of its trajectory.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/odometry/keyframe_graph.hpp"

namespace roomradar {

struct OdometryConfig {
  ViewConfig view;
  /// Colour has less weight than its noise justifies: the colour camera's calibration is inexact, and walls
  /// are glossy.
  AlignConfig align = {.intensity_sigma = 16.0F, .max_correction_m = 0.25F};
  /// For alignment of keyframes with one another. They are farther apart, where the depth's distortion shows;
  /// a wide robust kernel averages it out. Chosen on the kitchen recording, like the weight of colour above:
  /// each changes ATE and RPE over 30 frames by 0.3 mm or less.
  AlignConfig align_keyframes = {.robust_sigma = 4.0F, .intensity_sigma = 8.0F, .max_correction_m = 0.25F};
  KeyframeGraphConfig graph;
  KeyframeDatabaseConfig place;
  RelocaliseConfig relocalise;
  /// A view becomes a keyframe if every keyframe is farther away than this or turned by more than
  /// keyframe_angle_deg.
  double keyframe_distance_m = 0.10;
  double keyframe_angle_deg = 8.0;
  double keyframe_overlap = 0.7;      ///< below this overlap with the current keyframe, another one is used
  int references = 2;                 ///< max keyframes that a frame is aligned with
  int improve_every = 5;              ///< views averaged into a keyframe before its reference is rebuilt
  int apply_result_after_frames = 4;  ///< frames after which a new keyframe's background result is applied
};

/// Trajectory entry of one frame.
struct TrackedFrame {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  TrackStatus status = TrackStatus::kDiverged;
  bool trusted = false;  ///< only trusted frames may be fused
};

struct OdometryCounts {
  std::int64_t frames = 0;
  std::int64_t tracked = 0;      ///< frames with a trusted pose
  std::int64_t degenerate = 0;   ///< frames with an unconstrained direction
  std::int64_t lost = 0;         ///< frames without a pose
  std::int64_t relocalised = 0;  ///< recoveries from a loss by place recognition
  std::int64_t keyframes = 0;
  std::int64_t loops_found = 0;     ///< connected pairs of keyframes that are not neighbours in sequence
  std::int64_t loops_rejected = 0;  ///< pairs that should overlap, but did not align both ways
  std::int64_t anchored = 0;        ///< keyframes that were localised in the known map
};

}  // namespace roomradar
