// fusion.hpp: one depth frame into the octree, by whole nodes. Private to the static map.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mapping/depth_pyramid.hpp"
#include "mapping/fusion_config.hpp"
#include "mapping/room_octree.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Buffers kept from frame to frame.
struct FusionScratch {
  DepthPyramid pyramid;
  std::vector<std::uint64_t> hits;  ///< Morton codes of the voxels that rays end in, sorted, each once
  std::vector<std::uint64_t> row_keys;
  std::vector<std::uint64_t> sort_buffer;
};

enum class HitStatus { kCollected, kNone, kOutOfReach };

/// Fills scratch.hits from all pixels that measured something within max_range_m (kNone where no pixel holds
/// a depth at all). kOutOfReach where one of them ends outside the octree.
HitStatus collect_hits(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double resolution_m,
                       const FusionConfig& config, FusionScratch& scratch);

/// One descent from the root. A node wholly in front of all that is seen through it becomes free as a whole;
/// one wholly behind, or outside of the image, is left alone; the others are split down to leaves. A leaf
/// that a ray ends in is hit, one whose centre lies before the depth of its pixel is missed, and within the
/// truncation of that depth its signed distance, weight and colour are averaged. Needs scratch.hits of this
/// frame. Source: log-odds and clamping: Hornung et al., OctoMap, Autonomous Robots 2013, equations (2) and
/// (4); projective signed distance: Curless and Levoy, SIGGRAPH 1996, equations (3) and (4), with 1/sigma^2
/// as weight.
void fuse_depth(RoomOcTree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                const FusionConfig& config, FusionScratch& scratch);

}  // namespace roomradar
