// map_evidence.cpp: clamped log-odds of whole nodes, and weighted means of samples.
#include "mapping/octree/map_evidence.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

// Adds log-odds to everything in a node, with clamping.
class AddLogOdds {
 public:
  AddLogOdds(BlockOctree& tree, const FusionConfig& config, float log_odds)
      : tree_(tree), config_(config), added_(log_odds) {}

  [[nodiscard]] Slot to_node(Slot node, unsigned depth) const {
    if (!node.is_block()) return Slot::cube(sum(node.log_odds()));
    if (depth == kLeafDepth - 1) return to_voxels(node, 0xFFU);
    InnerBlock& block = tree_.inner(node);
    for (Slot& slot : block.slots) slot = to_node(slot, depth + 1);
    return tree_.prune(node, block);
  }
  [[nodiscard]] Slot to_voxels(Slot node, unsigned which) const {
    return change_leaves(tree_, node, [&](LeafBlock& block) {
      for (unsigned i = 0; i < 8; ++i)
        if ((which >> i & 1U) != 0) block.log_odds[i] = sum(block.log_odds[i]);
    });
  }

 private:
  [[nodiscard]] LogOdds sum(LogOdds before) const {
    const float unit = tree_.units().log_odds;
    const float after =
        std::clamp(static_cast<float>(before) * unit + added_, config_.min_log_odds, config_.max_log_odds);
    const auto steps = static_cast<LogOdds>(std::lround(after / unit));
    return steps == 0 ? LogOdds{1} : steps;
  }
  BlockOctree& tree_;
  const FusionConfig& config_;
  float added_;
};

// Averages a sample of another map into voxel i.
void add_sample(BlockOctree& tree, LeafBlock& block, unsigned i, const SurfaceSample& sample) {
  const BlockUnits& units = tree.units();
  const float weight = std::clamp(std::round(sample.weight / units.weight), 1.0F, 65535.0F);
  const float sum = static_cast<float>(block.weight[i]) + weight;
  const float part = weight / sum;
  if (sample.has_colour) {
    Rgb& own = tree.colours(block).colours[i];
    const float colour_part = (block.coloured >> i & 1U) != 0 ? part : 1.0F;
    const auto mean = [colour_part](std::uint8_t a, std::uint8_t b) {
      return static_cast<std::uint8_t>(std::lround(a + static_cast<float>(b - a) * colour_part));
    };
    own = {mean(own.r, sample.colour.r), mean(own.g, sample.colour.g), mean(own.b, sample.colour.b)};
    block.coloured |= static_cast<std::uint8_t>(1U << i);
  }
  const auto own_distance = static_cast<float>(block.distance[i]);
  const float distance = own_distance + (sample.distance_m / units.distance_m - own_distance) * part;
  block.distance[i] = static_cast<std::int16_t>(std::lround(std::clamp(distance, -32767.0F, 32767.0F)));
  block.weight[i] = static_cast<std::uint16_t>(std::min(sum, 65535.0F));
}

void require_cube(const VoxelIndex& lowest, int edge_voxels) {
  const Eigen::Array3i key = lowest.array() + kKeyOrigin;
  const bool sound = edge_voxels > 0 && edge_voxels <= 1 << kLeafDepth &&
                     std::has_single_bit(static_cast<unsigned>(edge_voxels)) &&
                     (lowest.array() >= -kKeyOrigin).all() && (lowest.array() < kKeyOrigin).all() &&
                     key.unaryExpr([&](int k) { return k & (edge_voxels - 1); }).isZero();
  if (sound) return;
  throw Error(
      "voxel " + std::to_string(lowest.x()) + " " + std::to_string(lowest.y()) + " " +
      std::to_string(lowest.z()) + " with an edge of " + std::to_string(edge_voxels) +
      " is no leaf of an octree: it must lie within +-32768, on a multiple of its edge, a power of two");
}

}  // namespace

void add_evidence(BlockOctree& tree, const FusionConfig& config, const MapLeaf& leaf) {
  require_cube(leaf.lowest_voxel, leaf.edge_voxels);
  if (!std::isfinite(leaf.log_odds)) throw Error("log-odds of a leaf must be finite");
  if (leaf.log_odds == 0.0F) return;
  const int log2_edge = std::countr_zero(static_cast<unsigned>(leaf.edge_voxels));
  const unsigned depth = kLeafDepth - static_cast<unsigned>(log2_edge);
  const NodePlace target{std::min(depth, kLeafDepth - 1), leaf.lowest_voxel.array() + kKeyOrigin};
  const AddLogOdds add(tree, config, leaf.log_odds);
  tree.root = change_node(tree, tree.root, {}, target, [&](Slot node) {
    return depth < kLeafDepth ? add.to_node(node, depth)
                              : add.to_voxels(node, 1U << target.towards(target.key));
  });
}

void add_evidence(BlockOctree& tree, const SurfaceSample& sample) {
  require_cube(sample.voxel, 1);
  if (!std::isfinite(sample.distance_m) || !(sample.weight > 0.0F) || !std::isfinite(sample.weight))
    throw Error("a sample's distance must be finite, its weight finite and > 0");
  const NodePlace target{kLeafDepth - 1, sample.voxel.array() + kKeyOrigin};
  tree.root = change_node(tree, tree.root, {}, target, [&](Slot node) {
    return change_leaves(
        tree, node, [&](LeafBlock& block) { add_sample(tree, block, target.towards(target.key), sample); });
  });
}

}  // namespace roomradar
