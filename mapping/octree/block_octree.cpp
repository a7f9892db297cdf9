// block_octree.cpp: the tree's units and size.
#include "mapping/octree/block_octree.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/octree/cell_levels.hpp"
#include "mapping/octree/depth_pyramid.hpp"

namespace roomradar {

BlockUnits::BlockUnits(double resolution_m, const FusionConfig& config)
    : log_odds(std::max(std::abs(config.min_log_odds), config.max_log_odds) / 32767.0F),
      distance_m(TruncationBand(resolution_m, config).widest_m(config.max_range_m) / 32767.0F),
      weight(config.max_weight / 65535.0F) {}

BlockOctree::BlockOctree(double resolution_m, const FusionConfig& config)
    : resolution_m_(resolution_m),
      units_(resolution_m, config),
      voxel_band_(static_cast<int>(
          TruncationBand(resolution_m, config)
              .half_width_m(std::min(coarse_from_m(resolution_m, config), config.max_range_m),
                            static_cast<float>(resolution_m)) /
          units_.distance_m)) {}

KeyRange keys_in(const Eigen::AlignedBox3d& box_world, double resolution_m) {
  if (box_world.isEmpty()) return {.first = Eigen::Array3i::Constant(1), .last = Eigen::Array3i::Zero()};
  const auto to_key = [](const Eigen::Array3d& voxel) -> Eigen::Array3i {
    return voxel.max(-1.0).min(65536.0).cast<int>();
  };
  const Eigen::Array3d low = box_world.min().array() / resolution_m + kKeyOrigin - 0.5;
  const Eigen::Array3d high = box_world.max().array() / resolution_m + kKeyOrigin - 0.5;
  return {.first = to_key(low.ceil()), .last = to_key(high.floor())};
}

bool is_plausible_cube(const BlockOctree& tree, LogOdds log_odds, unsigned depth) {
  constexpr int kMaxFree_voxels = 8192;
  constexpr double kMaxSolid_m = 4.0;
  const int edge_voxels = 1 << (kLeafDepth - depth);
  if (log_odds < 0) return edge_voxels <= kMaxFree_voxels;
  return log_odds > 0 && edge_voxels * tree.resolution_m() <= kMaxSolid_m;
}

SubtreeSize size_of(const BlockOctree& tree, Slot node, unsigned depth) {
  if (node.is_unknown()) return {};
  SubtreeSize size{.nodes = 1};
  if (!node.is_block()) return size;
  if (node.is_inner_block()) {
    size.bytes += sizeof(InnerBlock);
    for (const Slot child : tree.inner(node).slots) {
      const SubtreeSize below = size_of(tree, child, depth + 1);
      size.nodes += below.nodes;
      size.bytes += below.bytes;
    }
  } else {
    const LeafBlock& block = tree.leaves(node);
    size.bytes += sizeof(LeafBlock) + (block.coloured != 0 ? sizeof(ColourBlock) : 0);
    for (unsigned i = 0; i < 8; ++i) size.nodes += block.holds(i) ? 1 : 0;
  }
  return size;
}

}  // namespace roomradar
