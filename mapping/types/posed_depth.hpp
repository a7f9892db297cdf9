// posed_depth.hpp: a depth image with its camera and pose.
#pragma once
#include <Eigen/Geometry>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A depth image, its camera and its pose. Refers to all three, which must outlive it.
struct PosedDepth {
  const DepthImage& depth_m;  ///< height x width, metres along the optical axis; 0: no measurement
  const Intrinsics& camera;   ///< of the image's size
  const Eigen::Isometry3d& T_world_camera;
};

}  // namespace roomradar
