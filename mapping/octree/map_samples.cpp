// map_samples.cpp: voxels of coarse cells; clamped log-odds of whole nodes; weighted means of samples.
#include "mapping/octree/map_samples.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>

#include "mapping/octree/cell_levels.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

Occupancy occupancy_of(LogOdds log_odds) {
  if (log_odds == 0) return Occupancy::kUnknown;
  return log_odds > 0 ? Occupancy::kOccupied : Occupancy::kFree;
}

/// @param distance  signed distance of the voxel, in units of BlockUnits::distance_m
SurfaceSample sample_of(const BlockOctree& tree, const LeafBlock& block, unsigned i,
                        const Eigen::Array3i& key, std::int16_t distance) {
  return {.voxel = (key - kKeyOrigin).matrix(),
          .occupancy = occupancy_of(block.log_odds[i]),
          .distance_m = distance * tree.units().distance_m,
          .weight = block.weight[i] * tree.units().weight,
          .colour = tree.colour(block, i),
          .has_colour = (block.coloured >> i & 1U) != 0};
}

// Calls visit(SurfaceSample) for the voxels in cell i of a leaf block, which must have a signed distance.
template <typename Visit>
void visit_cell(const BlockOctree& tree, const NodePlace& place, const LeafBlock& block, const Sides& sides,
                unsigned i, const Visit& visit) {
  const NodePlace cell = place.child(i);
  if (cell.depth == kLeafDepth) return visit(sample_of(tree, block, i, cell.key, block.distance[i]));
  const std::array<std::int16_t, 8> distances = voxel_distances(tree, block, sides, i);
  for (unsigned j = 0; j < 8; ++j) visit(sample_of(tree, block, i, cell.child(j).key, distances[j]));
}

// Node that contains a voxel: a leaf block and the index in it of the voxel's cell, or a node that is not a
// block.
struct Found {
  Eigen::Array3i key = Eigen::Array3i::Zero();
  Slot node{};
  NodePlace place{};  // of the node
  const LeafBlock* block = nullptr;
  unsigned i = 0;

  [[nodiscard]] LogOdds log_odds() const { return block ? block->log_odds[i] : node.log_odds(); }
};

// Returns the deepest node that contains a voxel, down to max_depth, and sets its place.
Slot node_at(const BlockOctree& tree, const Eigen::Array3i& key, unsigned max_depth, NodePlace& place) {
  Slot node = tree.root;
  for (place = {}; node.is_inner_block() && place.depth < max_depth;) {
    const unsigned i = place.towards(key);
    node = tree.inner(node).slots[i];
    place = place.child(i);
  }
  return node;
}

Found find(const BlockOctree& tree, const Eigen::Vector3d& p_world) {
  const Eigen::Array3d voxel = (p_world / tree.resolution_m()).array().floor() + kKeyOrigin;
  if (!(voxel >= 0.0).all() || !(voxel <= 65535.0).all()) return {};
  Found found{.key = voxel.cast<int>()};
  found.node = node_at(tree, found.key, kLeafDepth, found.place);
  if (!found.node.is_block()) return found;
  found.block = &tree.leaves(found.node);
  found.i = found.place.towards(found.key);
  return found;
}

void perform(SampleAction action, LogOdds free, LeafBlock& block, unsigned i) {
  if (action == SampleAction::kKeep) return;
  erase_sample(block, i);
  if (action == SampleAction::kFree) block.log_odds[i] = free;
  if (action == SampleAction::kUnknown) block.log_odds[i] = 0;
}

using Decide = std::function<SampleAction(const SurfaceSample&)>;

// revise() for a leaf block of coarse cells.
Slot revise_coarse(BlockOctree& tree, Slot node, const NodePlace& place, LogOdds free, const KeyRange& range,
                   const Decide& decide) {
  const LeafBlock& coarse = tree.leaves(node);
  std::array<std::array<SampleAction, 8>, 8> actions{};  // of the voxels in each cell
  static_assert(SampleAction{} == SampleAction::kKeep);
  for (unsigned i = 0; i < 8; ++i) {
    if (!coarse.holds(i) || (coarse.weight[i] == 0 && coarse.log_odds[i] < 0)) continue;
    unsigned j = 0;
    visit_cell(tree, place, coarse, {}, i, [&](const SurfaceSample& sample) {
      SampleAction& action = actions[i][j++];
      if (range.holds(sample.voxel.array() + kKeyOrigin)) action = decide(sample);
    });
  }
  for (unsigned i = 0; i < 8; ++i) {
    if (actions[i] == std::array<SampleAction, 8>{}) continue;
    node = change_node(tree, node, place, place.child(i), [&](Slot cell) {
      return change_leaves(tree, cell, [&](LeafBlock& block) {
        for (unsigned j = 0; j < 8; ++j) perform(actions[i][j], free, block, j);
      });
    });
  }
  return node;
}

// Calls `decide` on every voxel of the subtree that has a sample or is occupied, and is in the range. Coarse
// cells are refined if an action other than kKeep is returned for a voxel. Returns the node's new state.
Slot revise(BlockOctree& tree, Slot node, const NodePlace& place, LogOdds free, const KeyRange& range,
            const Decide& decide) {
  if (!node.is_block() || !range.meets(place)) return node;
  if (node.is_leaf_block() && place.depth == kCoarseDepth)
    return revise_coarse(tree, node, place, free, range, decide);
  if (node.is_leaf_block())
    return change_leaves(tree, node, [&](LeafBlock& block) {
      for (unsigned i = 0; i < 8; ++i) {
        const bool is_surface = block.weight[i] != 0 || block.log_odds[i] > 0;
        if (!is_surface || !range.holds(place.child(i).key)) continue;
        perform(decide(sample_of(tree, block, i, place.child(i).key, block.distance[i])), free, block, i);
      }
    });
  InnerBlock& block = tree.inner(node);
  for (unsigned i = 0; i < 8; ++i)
    block.slots[i] = revise(tree, block.slots[i], place.child(i), free, range, decide);
  return tree.prune(node, block);
}

// Returns the sides of the node at `place`.
Sides sides_of(const BlockOctree& tree, const NodePlace& place) {
  Sides sides;
  for (unsigned k = 0; k < sides.size(); ++k) {
    Eigen::Array3i key = place.key;
    key[k / 2] += k % 2 == 0 ? -place.edge_voxels() : place.edge_voxels();
    if ((key < 0).any() || (key > 65535).any()) continue;
    NodePlace at;
    const Slot node = node_at(tree, key, place.depth, at);
    if (at.depth == place.depth) sides[k] = node;
  }
  return sides;
}

// Adds log-odds to everything in a node, with clamping.
class AddLogOdds {
 public:
  AddLogOdds(BlockOctree& tree, const FusionConfig& config, float log_odds)
      : tree_(tree), config_(config), added_(log_odds) {}

  [[nodiscard]] Slot to_node(Slot node, unsigned depth) const {
    if (!node.is_block()) return Slot::cube(sum(node.log_odds()));
    if (node.is_leaf_block()) return to_cells(node, 0xFFU);
    InnerBlock& block = tree_.inner(node);
    for (Slot& slot : block.slots) slot = to_node(slot, depth + 1);
    return tree_.prune(node, block);
  }
  // Adds to the cells of a leaf block whose bit is set, or to the voxels of a node at depth 15.
  [[nodiscard]] Slot to_cells(Slot node, unsigned which) const {
    return change_leaves(tree_, node, [&](LeafBlock& block) {
      for (unsigned i = 0; i < 8; ++i)
        if ((which >> i & 1U) != 0) block.log_odds[i] = sum(block.log_odds[i]);
    });
  }

  [[nodiscard]] LogOdds sum(LogOdds before) const {
    const float unit = tree_.units().log_odds;
    const float after =
        std::clamp(static_cast<float>(before) * unit + added_, config_.min_log_odds, config_.max_log_odds);
    const auto steps = static_cast<LogOdds>(std::lround(after / unit));
    return steps == 0 ? LogOdds{1} : steps;
  }

 private:
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
      " is not a leaf of an octree: it must lie within +-32768, on a multiple of its edge, a power of two");
}

// Adds another map's nodes in a range of keys to a tree. No leaf block may be partly in the range.
class AddMap {
 public:
  AddMap(BlockOctree& tree, const FusionConfig& config, const BlockOctree& other, const KeyRange& range)
      : tree_(tree), config_(config), other_(other), range_(range) {}

  /// Returns the new state of the tree's `node` after the other map's node at the same place was added.
  Slot add(Slot node, Slot others, const Sides& others_sides, const NodePlace& place) {
    if (others.is_unknown() || !range_.meets(place)) return node;
    const bool is_whole = range_.holds(place.key) && range_.holds(place.key + (place.edge_voxels() - 1));
    if (others.is_cube() && is_whole) return add_log_odds(node, others.log_odds(), place.depth);
    if (others.is_leaf_block()) {
      const LeafBlock& block = other_.leaves(others);
      if (place.depth == kLeafDepth - 1) return add_cells(node, block, place);
      return may_be_coarse(tree_, node) ? add_coarse(node, block, place)
                                        : add_voxels(node, block, others_sides, place);
    }
    if (node.is_leaf_block()) node = refined(tree_, node);
    InnerBlock made;
    if (!node.is_block()) made = opened(node);
    InnerBlock& block = node.is_block() ? tree_.inner(node) : made;
    const InnerBlock from = others.is_cube() ? opened(others) : other_.inner(others);
    for (unsigned i = 0; i < 8; ++i)
      block.slots[i] =
          add(block.slots[i], from.slots[i], sides_of_child(other_, from, others_sides, i), place.child(i));
    return tree_.prune(node, block);
  }

 private:
  [[nodiscard]] AddLogOdds adder(LogOdds steps) const {
    return {tree_, config_, static_cast<float>(steps) * other_.units().log_odds};
  }
  Slot add_log_odds(Slot node, LogOdds steps, unsigned depth) { return adder(steps).to_node(node, depth); }

  // Adds cells to a leaf block of the same size of cells.
  void add_to(LeafBlock& into, const LeafBlock& block, const NodePlace& place) {
    for (unsigned i = 0; i < 8; ++i) {
      if (block.log_odds[i] != 0) into.log_odds[i] = adder(block.log_odds[i]).sum(into.log_odds[i]);
      if (block.weight[i] != 0)
        add_sample(tree_, into, i, sample_of(other_, block, i, place.child(i).key, block.distance[i]));
    }
  }
  Slot add_cells(Slot node, const LeafBlock& block, const NodePlace& place) {
    return change_leaves(tree_, node, [&](LeafBlock& into) { add_to(into, block, place); });
  }
  Slot add_coarse(Slot node, const LeafBlock& block, const NodePlace& place) {
    LeafBlock made;
    if (!node.is_leaf_block()) made = opened_coarse(tree_, node);
    LeafBlock& into = node.is_leaf_block() ? tree_.leaves(node) : made;
    add_to(into, block, place);
    return prune_coarse(tree_, node, into);
  }
  // Adds coarse cells to a node that has fine ones.
  Slot add_voxels(Slot node, const LeafBlock& block, const Sides& sides, const NodePlace& place) {
    InnerBlock& children = tree_.inner(node);
    for (unsigned i = 0; i < 8; ++i) {
      Slot& child = children.slots[i];
      if (block.log_odds[i] != 0) child = add_log_odds(child, block.log_odds[i], place.depth + 1);
      if (block.weight[i] == 0) continue;
      child = change_leaves(tree_, child, [&](LeafBlock& into) {
        unsigned j = 0;
        visit_cell(other_, place, block, sides, i,
                   [&](const SurfaceSample& sample) { add_sample(tree_, into, j++, sample); });
      });
    }
    return tree_.prune(node, children);
  }

  BlockOctree& tree_;
  const FusionConfig& config_;
  const BlockOctree& other_;
  KeyRange range_;
};

}  // namespace

Occupancy occupancy_at(const BlockOctree& tree, const Eigen::Vector3d& p_world) {
  return occupancy_of(find(tree, p_world).log_odds());
}

std::optional<SurfaceSample> sample_at(const BlockOctree& tree, const Eigen::Vector3d& p_world) {
  const Found found = find(tree, p_world);
  if (!found.block || found.block->weight[found.i] == 0) return std::nullopt;
  const NodePlace cell = found.place.child(found.i);
  if (cell.depth == kLeafDepth)
    return sample_of(tree, *found.block, found.i, found.key, found.block->distance[found.i]);
  const auto distances = voxel_distances(tree, *found.block, sides_of(tree, found.place), found.i);
  return sample_of(tree, *found.block, found.i, found.key, distances[cell.towards(found.key)]);
}

void visit_samples(const BlockOctree& tree, const KeyRange& range,
                   const std::function<void(const SurfaceSample&)>& visit) {
  const auto in_range = [&](const SurfaceSample& sample) {
    if (range.holds(sample.voxel.array() + kKeyOrigin)) visit(sample);
  };
  for_each_cell(tree, tree.root, {}, {}, range,
                [&](const NodePlace& place, const LeafBlock& block, const Sides& sides, unsigned i) {
                  visit_cell(tree, place, block, sides, i, in_range);
                });
}

void visit_cells(const BlockOctree& tree, const KeyRange& range,
                 const std::function<void(const SurfaceSample&, int)>& visit) {
  for_each_cell(tree, tree.root, {}, {}, range,
                [&](const NodePlace& place, const LeafBlock& block, const Sides&, unsigned i) {
                  const NodePlace cell = place.child(i);
                  visit(sample_of(tree, block, i, cell.key, block.distance[i]), cell.edge_voxels());
                });
}

void revise_samples(BlockOctree& tree, const FusionConfig& config, const KeyRange& range,
                    const std::function<SampleAction(const SurfaceSample&)>& decide) {
  const long free = std::lround(config.min_log_odds / tree.units().log_odds);
  tree.root = revise(tree, tree.root, {}, static_cast<LogOdds>(free), range, decide);
}

void add_evidence(BlockOctree& tree, const FusionConfig& config, const BlockOctree& other,
                  const KeyRange& range) {
  if (tree.resolution_m() != other.resolution_m())
    throw Error("maps with different resolutions cannot be added cell by cell");
  constexpr int kBlock = 1 << (kLeafDepth - kCoarseDepth);
  const auto is_at_block = [](const Eigen::Array3i& key) {
    return key.unaryExpr([](int k) { return k & (kBlock - 1); }).isZero();
  };
  if (!is_at_block(range.first) || !is_at_block(range.last + 1))
    throw Error("a part of a map must begin and end at multiples of " + std::to_string(kBlock) + " voxels");
  tree.root = AddMap(tree, config, other, range).add(tree.root, other.root, {}, {});
}

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
                              : add.to_cells(node, 1U << target.towards(target.key));
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
