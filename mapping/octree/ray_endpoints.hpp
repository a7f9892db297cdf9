// ray_endpoints.hpp: collects a frame's ray endpoints per leaf block. Private to StaticMap.
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

}  // namespace roomradar
