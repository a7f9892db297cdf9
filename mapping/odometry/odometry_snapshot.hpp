// odometry_snapshot.hpp: all that an odometry knows between two frames, as plain data.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/odometry/keyframe_graph.hpp"
#include "mapping/odometry/odometry.hpp"

namespace roomradar {

/// A frame as it is kept: relative to a keyframe, so that it moves when the keyframe is moved.
struct KeptFrame {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  std::optional<std::size_t> keyframe;  ///< none: the pose is in the world, and fixed
  Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
  TrackStatus status = TrackStatus::kDiverged;
  bool trusted = false;
};

struct OdometrySnapshot {
  OdometryCounts counts;
  KeyframeGraph graph;
  Places places;  ///< one a keyframe; of frames with given poses there are places alone
  std::vector<KeptFrame> frames;
  std::size_t current = 0;  ///< the keyframe that the last frame was aligned with first
  int improved = 0;         ///< views averaged into it since its reference was made
  Eigen::Isometry3d T_world_last = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_last_next = Eigen::Isometry3d::Identity();  ///< the last motion from frame to frame
  double way_m = 0.0;                                             ///< see Keyframe
  Image<float> last_moved_grey;                                   ///< what the camera saw when it last moved
  Tracking last_moved;   ///< the answer for that frame; its pose is trusted
  bool located = false;  ///< the world is that of the known places
};

}  // namespace roomradar
