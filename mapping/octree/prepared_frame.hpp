// prepared_frame.hpp: the part of a frame's fusion that does not depend on the map's content.
#pragma once
#include <Eigen/Geometry>

#include "mapping/octree/fusion_config.hpp"
#include "mapping/octree/ray_endpoints.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Intermediate result of StaticMap::fuse(). Reuse an object for many frames, so that its memory is allocated
/// once.
struct PreparedFrame {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  FusionConfig config;                               ///< the map's, with the frame's noise
  FusionScratch scratch;                             ///< valid if status is kFused
  FuseStatus status = FuseStatus::kNothingMeasured;  ///< kFused: the frame can be fused
};

/// Checks the frame and its pose, and computes the bounds of its depth and the endpoints of its rays.
/// @param threads  1: on the caller's thread
void prepare_frame(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double resolution_m,
                   const FusionConfig& config, unsigned threads, PreparedFrame& prepared);

}  // namespace roomradar
