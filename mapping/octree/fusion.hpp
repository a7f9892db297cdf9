// fusion.hpp: fuses one depth frame into the octree, whole nodes at a time. Private to StaticMap.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/depth_pyramid.hpp"
#include "mapping/octree/fusion_config.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Ray endpoints in one leaf block: the block's Morton code and a bit for each voxel that contains one.
class BlockHits {
 public:
  BlockHits() = default;
  BlockHits(std::uint64_t block_code, unsigned voxels) : bits_(block_code << 8U | voxels) {}
  [[nodiscard]] std::uint64_t block_code() const { return bits_ >> 8U; }
  [[nodiscard]] unsigned voxels() const { return bits_ & 0xFFU; }
  /// Child index, within its parent, of the block's ancestor at `depth`.
  [[nodiscard]] unsigned child(unsigned depth) const {
    return static_cast<unsigned>(bits_ >> (8U + 3U * (kLeafDepth - 1 - depth))) & 7U;
  }
  void add(unsigned voxels) { bits_ |= voxels; }

 private:
  std::uint64_t bits_ = 0;
};

/// Buffers reused from frame to frame.
struct FusionScratch {
  DepthPyramid pyramid;
  std::vector<BlockHits> hits;  ///< sorted by code, each block once
  std::vector<BlockHits> sort_buffer;
  std::vector<float> ray_x;
  std::vector<int> row_keys[2][3];  ///< x, y and z keys of the previous and the current row
  std::vector<std::uint8_t> is_new;
  std::vector<std::uint32_t> columns;
};

enum class HitStatus { kCollected, kNone, kOutOfBounds };

/// Fills scratch.hits with the ray endpoints of all pixels that have depth within max_range_m. Returns kNone
/// if no pixel has depth at any range, kOutOfBounds if an endpoint is outside the octree.
HitStatus collect_hits(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double resolution_m,
                       const FusionConfig& config, FusionScratch& scratch);

/// SIMD version for eight siblings: the fastest that the processor has, or the portable one. Results are
/// equal.
enum class Arithmetic { kFastest, kPortable };

/// Fuses the frame in one descent from the root; needs this frame's scratch.hits. A node wholly in front of
/// the measured depth becomes free as a whole. A node wholly occluded or outside the image is unchanged.
/// Other nodes are split down to leaves. A leaf that contains a ray endpoint is a hit; a leaf whose centre is
/// in front of its pixel's depth is a miss. Within the truncation of that depth, signed distance, weight and
/// colour are averaged. Source: log-odds and clamping: Hornung et al., OctoMap, Autonomous Robots 2013,
/// equations (2) and (4); projective signed distance: Curless and Levoy, SIGGRAPH 1996, equations (3) and
/// (4), with 1/sigma^2 as weight.
void fuse_depth(BlockOctree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                const FusionConfig& config, FusionScratch& scratch,
                Arithmetic arithmetic = Arithmetic::kFastest);

}  // namespace roomradar
