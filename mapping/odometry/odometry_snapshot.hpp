// odometry_snapshot.hpp: complete state of an odometry between two frames, as plain data.
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
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Frame with its pose relative to a keyframe, so the frame moves with the keyframe.
struct KeptFrame {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  std::optional<std::size_t> keyframe;  ///< unset: T_keyframe_camera is the pose in the world, and constant
  Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
  TrackStatus status = TrackStatus::kDiverged;
  bool trusted = false;
};

struct OdometrySnapshot {
  OdometryCounts counts;
  KeyframeGraph graph;
  KeyframeDatabase keyframe_database;  ///< one per keyframe; add_posed() adds entries without keyframes
  std::vector<KeptFrame> frames;
  std::size_t current = 0;  ///< keyframe that the last frame was aligned with first
  int improved = 0;         ///< views averaged into it since its reference was built
  Eigen::Isometry3d T_world_last = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_last_next = Eigen::Isometry3d::Identity();  ///< predicted motion to the next frame
  double path_length_m = 0.0;                                     ///< see Keyframe
  Image<float> last_moved_grey;  ///< intensity image when the camera last moved
  Tracking last_moved;           ///< result for that frame; its pose is trusted
  bool located = false;          ///< the world is that of the known map
};

/// Applies new keyframe poses. The camera's poses move with the current keyframe, whose motion is returned.
/// @param moved  one per keyframe of kept.graph, except perhaps the newest
Eigen::Isometry3d move_keyframes(const std::vector<Keyframe>& moved, OdometrySnapshot& kept);

/// Applies the second thread's result; returns the motion of the current keyframe. If the newest keyframe was
/// localised in the known map, anchors it there, and moves the world to the map's the first time.
Eigen::Isometry3d take_over(KeyframeJobResult result, OdometrySnapshot& kept);

/// Adds a frame; its pose moves with the current keyframe from now on.
void keep(OdometrySnapshot& kept, const Frame& frame, const Tracking& tracking);

/// Returns all frames with their poses in the world.
std::vector<TrackedFrame> trajectory_of(const OdometrySnapshot& kept);

}  // namespace roomradar
