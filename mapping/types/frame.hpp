// frame.hpp: what a depth sensor delivers at one instant.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// "The camera" of a frame is its depth camera; the colour camera stands beside it, T_colour_depth away.
struct Frame {
  std::int64_t index = 0;  ///< position in the recording, counted from 0, skipped frames counted too
  double stamp_s = 0.0;    ///< sensor time; a recording without stamps gets index / 30

  DepthImage depth_m;  ///< of depth_camera's size
  Intrinsics depth_camera;

  ColourImage colour;  ///< of colour_camera's size, or empty where the source has none
  Intrinsics colour_camera;
  double colour_after_depth_s = 0.0;  ///< how much later the colour was taken; 0 where the source cannot say
  /// Depth-camera points to colour-camera points.
  Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();

  std::optional<Eigen::Isometry3d> T_world_camera;  ///< of the depth camera, in the recording's own world
  std::optional<Eigen::Vector3d> down_camera;       ///< unit direction of gravity in the camera frame
};

}  // namespace roomradar
