// fusion.hpp: fuses one depth frame into the octree. Updates whole nodes where possible. Private to
// StaticMap.
#pragma once
#include <Eigen/Geometry>

#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/fusion_config.hpp"
#include "mapping/octree/ray_endpoints.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/simd8f.hpp"

namespace roomradar {

/// How a frame is fused. The result does not depend on it.
struct FusionExecution {
  unsigned threads = 1;  ///< 1..kMaxLanes
  Arithmetic arithmetic = Arithmetic::kFastest;
};

/// Fuses the frame in one descent from the root. Call build_pyramid() and collect_hits() for this frame and
/// `scratch` first. All voxels of a node wholly in front of the measured depth are misses. A node wholly
/// occluded or outside the image is unchanged. All other nodes are split down to leaves. A leaf that contains
/// a ray endpoint is a hit. A leaf whose centre is in front of the depth of the pixel to which it projects is
/// a miss. Hits and misses add to the log-odds. Signed distance, weight and colour are averaged into leaves
/// within the truncation band. Sources: Hornung et al., OctoMap, Autonomous Robots 2013, equations (2) and
/// (4) (log-odds and clamping); Curless and Levoy, SIGGRAPH 1996, equations (3) and (4), with 1/sigma^2 as
/// weight (projective TSDF).
void fuse_depth(BlockOctree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                const FusionConfig& config, const FusionScratch& scratch, const FusionExecution& execution);

}  // namespace roomradar
