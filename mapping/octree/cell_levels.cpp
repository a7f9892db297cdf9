// cell_levels.cpp: conversions between coarse cells, voxels and cubes.
#include "mapping/octree/cell_levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace roomradar {

float coarse_from_m(double resolution_m, const FusionConfig& config) {
  constexpr float kNever_m = std::numeric_limits<float>::infinity();
  if (config.max_cell_sigmas <= 0.0F) return kNever_m;
  const float from_m =
      depth_of_sigma_m(config.noise, 2.0F * static_cast<float>(resolution_m) / config.max_cell_sigmas);
  return from_m < config.max_range_m ? from_m : kNever_m;
}

Sides sides_of_child(const BlockOctree& tree, const InnerBlock& block, const Sides& of_parent, unsigned i) {
  Sides sides;
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned side = 0; side < 2; ++side) {
      const unsigned other = i ^ 1U << axis;
      if ((i >> axis & 1U) != side)
        sides[2 * axis + side] = block.slots[other];
      else if (const Slot beyond = of_parent[2 * axis + side]; beyond.is_inner_block())
        sides[2 * axis + side] = tree.inner(beyond).slots[other];
    }
  return sides;
}

namespace {

std::optional<float> cell_distance(const LeafBlock& coarse, unsigned i) {
  return coarse.weight[i] == 0 ? std::nullopt : std::optional(static_cast<float>(coarse.distance[i]));
}
// Returns the distance of coarse cell i of a node at kCoarseDepth: the mean of its voxels if it is refined.
std::optional<float> cell_distance(const BlockOctree& tree, Slot node, unsigned i) {
  if (node.is_leaf_block()) return cell_distance(tree.leaves(node), i);
  if (!node.is_inner_block() || !tree.inner(node).slots[i].is_leaf_block()) return std::nullopt;
  const LeafBlock& voxels = tree.leaves(tree.inner(node).slots[i]);
  if (std::ranges::find(voxels.weight, 0) != voxels.weight.end()) return std::nullopt;
  return static_cast<float>(std::accumulate(voxels.distance.begin(), voxels.distance.end(), 0)) / 8.0F;
}

}  // namespace

std::array<std::int16_t, 8> voxel_distances(const BlockOctree& tree, const LeafBlock& coarse,
                                            const Sides& sides, unsigned i) {
  const auto own = static_cast<float>(coarse.distance[i]);
  std::array<std::array<float, 2>, 3> quarter_step{};  // [axis][side]: change of distance towards the side
  for (unsigned axis = 0; axis < 3; ++axis) {
    std::array<std::optional<float>, 2> step;
    for (unsigned side = 0; side < 2; ++side) {
      const unsigned other = i ^ 1U << axis;
      const auto distance = (i >> axis & 1U) != side ? cell_distance(coarse, other)
                                                     : cell_distance(tree, sides[2 * axis + side], other);
      if (distance) step[side] = 0.25F * (*distance - own);
    }
    for (unsigned side = 0; side < 2; ++side)
      quarter_step[axis][side] = step[side] ? *step[side] : -step[1 - side].value_or(0.0F);
  }
  std::array<std::int16_t, 8> distances{};
  for (unsigned j = 0; j < 8; ++j) {
    const float distance =
        own + quarter_step[0][j & 1U] + quarter_step[1][j >> 1U & 1U] + quarter_step[2][j >> 2U & 1U];
    distances[j] = static_cast<std::int16_t>(std::lround(std::clamp(distance, -32767.0F, 32767.0F)));
  }
  return distances;
}

Slot refined(OctreeWriter tree, Slot node) {
  const LeafBlock coarse = tree.leaves(node);
  InnerBlock children;
  for (unsigned i = 0; i < 8; ++i) {
    LeafBlock voxels = opened_leaves(Slot::cube(coarse.log_odds[i]));
    if (coarse.weight[i] != 0) {
      voxels.weight.fill(coarse.weight[i]);
      voxels.distance = voxel_distances(tree, coarse, {}, i);
    }
    if ((coarse.coloured >> i & 1U) != 0) {
      const Rgb colour = tree.tree().colour(coarse, i);
      tree.colours(voxels).colours.fill(colour);
      voxels.coloured = 0xFFU;
    }
    for (unsigned j = 0; j < 8; ++j)
      if (voxels.distance[j] > tree.tree().voxel_band()) erase_sample(voxels, j);
    children.slots[i] = tree.prune(Slot(), voxels);
  }
  tree.free_leaves(node, coarse);
  return tree.prune(Slot(), children);
}

bool may_be_coarse(const BlockOctree& tree, Slot node) {
  if (!node.is_inner_block()) return true;
  const InnerBlock& block = tree.inner(node);
  return std::none_of(block.slots.begin(), block.slots.end(), [](Slot child) { return child.is_block(); });
}

LeafBlock opened_coarse(const BlockOctree& tree, Slot node) {
  if (!node.is_inner_block()) return opened_leaves(node);
  LeafBlock block;
  const InnerBlock& children = tree.inner(node);
  for (unsigned i = 0; i < 8; ++i) block.log_odds[i] = children.slots[i].log_odds();
  return block;
}

Slot prune_coarse(OctreeWriter tree, Slot node, const LeafBlock& block) {
  if (block.has_samples()) {
    if (node.is_leaf_block()) return node;
    if (node.is_inner_block()) tree.free_inner(node);
    return tree.prune(Slot(), block);
  }
  InnerBlock children;
  for (unsigned i = 0; i < 8; ++i) children.slots[i] = Slot::cube(block.log_odds[i]);
  if (node.is_inner_block()) return tree.prune(node, tree.inner(node) = children);
  tree.free_leaves(node, block);
  return tree.prune(Slot(), children);
}

}  // namespace roomradar
