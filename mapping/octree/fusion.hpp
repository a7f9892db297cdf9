// fusion.hpp: one depth frame into the octree, by whole nodes. Private to the static map.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/depth_pyramid.hpp"
#include "mapping/octree/fusion_config.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// The voxels of one leaf block that rays end in: the Morton code of the block, and a bit for each voxel.
class BlockHits {
 public:
  BlockHits() = default;
  BlockHits(std::uint64_t block_code, unsigned voxels) : bits_(block_code << 8U | voxels) {}
  [[nodiscard]] std::uint64_t block_code() const { return bits_ >> 8U; }
  [[nodiscard]] unsigned voxels() const { return bits_ & 0xFFU; }
  /// Which child of the node at depth - 1 that holds the block does so.
  [[nodiscard]] unsigned child(unsigned depth) const {
    return static_cast<unsigned>(bits_ >> (8U + 3U * (kLeafDepth - 1 - depth))) & 7U;
  }
  void add(unsigned voxels) { bits_ |= voxels; }

 private:
  std::uint64_t bits_ = 0;
};

/// Buffers kept from frame to frame.
struct FusionScratch {
  DepthPyramid pyramid;
  std::vector<BlockHits> hits;  ///< sorted by code, each block once
  std::vector<BlockHits> sort_buffer;
  std::vector<float> ray_x;
  std::vector<int> row_keys[2][3];  ///< of the row before and this one: x, y and z
  std::vector<std::uint8_t> is_new;
  std::vector<std::uint32_t> columns;
};

enum class HitStatus { kCollected, kNone, kOutOfReach };

/// Fills scratch.hits from all pixels that measured something within max_range_m (kNone where no pixel holds
/// a depth at all). kOutOfReach where one of them ends outside the octree.
HitStatus collect_hits(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double resolution_m,
                       const FusionConfig& config, FusionScratch& scratch);

/// How eight siblings are computed with: the fast way where the processor has one. The answers are the same.
enum class Arithmetic { kFastest, kPlain };

/// One descent from the root. A node wholly in front of all that is seen through it becomes free as a whole;
/// one wholly behind, or outside of the image, is left alone; the others are split down to leaves. A leaf
/// that a ray ends in is hit, one whose centre lies before the depth of its pixel is missed, and within the
/// truncation of that depth its signed distance, weight and colour are averaged. Needs scratch.hits of this
/// frame. Source: log-odds and clamping: Hornung et al., OctoMap, Autonomous Robots 2013, equations (2) and
/// (4); projective signed distance: Curless and Levoy, SIGGRAPH 1996, equations (3) and (4), with 1/sigma^2
/// as weight.
void fuse_depth(BlockOctree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                const FusionConfig& config, FusionScratch& scratch,
                Arithmetic arithmetic = Arithmetic::kFastest);

}  // namespace roomradar
