// ray_endpoints.hpp: collects the endpoints of a frame's rays, grouped per leaf block. Private to StaticMap.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/depth_pyramid.hpp"
#include "mapping/octree/fusion_config.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Ray endpoints in one leaf block: Morton code of the block, and one bit per voxel that contains an
/// endpoint.
class BlockHits {
 public:
  BlockHits() = default;
  BlockHits(std::uint64_t block_code, unsigned voxels) : bits_(block_code << 8U | voxels) {}
  [[nodiscard]] std::uint64_t block_code() const { return bits_ >> 8U; }
  [[nodiscard]] unsigned voxels() const { return bits_ & 0xFFU; }
  /// Returns the child index of the node at `depth` (1 to 15) on the path from the root to the block.
  [[nodiscard]] unsigned child(unsigned depth) const {
    return static_cast<unsigned>(bits_ >> (8U + 3U * (kLeafDepth - 1 - depth))) & 7U;
  }
  void add(unsigned voxels) { bits_ |= voxels; }

 private:
  std::uint64_t bits_ = 0;
};

/// Buffers that are reused for each frame.
struct FusionScratch {
  DepthPyramid pyramid;
  std::vector<BlockHits> hits;  ///< one entry per block with endpoints, sorted by Morton code
  // The rest is scratch of collect_hits().
  std::vector<BlockHits> sort_buffer;
  std::vector<float> ray_x;
  std::vector<int> row_keys[2][3];  ///< keys of endpoints: [previous, current row][x, y, z]
  std::vector<std::uint8_t> is_new;
  std::vector<std::uint32_t> columns;
};

enum class HitStatus { kCollected, kNone, kOutOfBounds };

/// Sets scratch.hits to the ray endpoints of all pixels with a depth of at most max_range_m. Returns kNone if
/// no pixel has any depth (including depths beyond max_range_m), and kOutOfBounds if an endpoint is outside
/// the octree.
HitStatus collect_hits(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double resolution_m,
                       const FusionConfig& config, FusionScratch& scratch);

}  // namespace roomradar
