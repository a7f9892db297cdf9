// fusion.cpp: the octree descent that fuses one depth frame.
#include "mapping/octree/fusion.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <vector>

#include "mapping/octree/leaf_update.hpp"
#include "mapping/octree/node_visibility.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

using HitRange = std::span<const BlockHits>;

// A sample fades only if a box this many times the size of its node is seen through: at depth edges, small
// pose errors let rays pass surfaces that are still there.
constexpr float kClearance = 3.0F;

// The hits in each child of a node. Input is sorted, so those of child i precede those of child i + 1.
struct ChildHits {
  unsigned mask = 0;  // bit i: child i has hits
  std::array<HitRange, 8> in;

  ChildHits(HitRange hits, unsigned child_depth) {
    while (!hits.empty()) {
      const unsigned i = hits.front().child(child_depth);
      const auto end = std::partition_point(
          hits.begin(), hits.end(), [&](const BlockHits& hit) { return hit.child(child_depth) == i; });
      in[i] = hits.first(static_cast<std::size_t>(end - hits.begin()));
      hits = hits.subspan(in[i].size());
      mask |= 1U << i;
    }
  }
};

template <typename Float8>
class Descent {
 public:
  Descent(BlockOctree& tree, const Frame& frame, const Eigen::Isometry3d& T_camera_world,
          const FusionConfig& config, const DepthPyramid& pyramid)
      : tree_(tree),
        config_(config),
        pyramid_(pyramid),
        camera_(frame.depth_camera),
        offsets_(T_camera_world.linear(), tree.resolution_m()),
        voxels_(tree, frame, config, CellSize::kVoxel),
        coarse_cells_(tree, frame, config, CellSize::kCoarse),
        coarse_from_m_(coarse_from_m(tree.resolution_m(), config)),
        frame_index_(static_cast<std::uint64_t>(frame.index)) {}

  /// @param root_centre  centre of the whole tree in the camera frame, m
  /// @param threads      1..kMaxLanes; the result does not depend on it
  void run(const Eigen::Vector3d& root_centre, HitRange hits, unsigned threads) {
    const Cell root = cell_at(0, root_centre, 0, hits);
    std::vector<Cell> branches;
    if (threads > 1) branches_ = &branches;
    tree_.root = update(tree_.root, 0, root);
    branches_ = nullptr;
    if (branches.empty()) return;
    update_branches(branches, threads);
    tree_.gather_free();
    tree_.root = prune_above_branches(tree_.root, 0);
  }

 private:
  // A node above depth 15 being descended into.
  struct Cell {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // in the camera frame, m
    std::uint64_t code = 0;                            // Morton code
    HitRange hits;
    NodeVisibility children;
  };
  // Nodes at this depth are updated on any thread, since they share no block. They have an edge of 64 voxels;
  // a room has hundreds.
  static constexpr unsigned kBranchDepth = 10;

  Cell cell_at(unsigned depth, const Eigen::Vector3d& centre, std::uint64_t code, HitRange hits) const {
    return {centre, code, hits, judge_children(depth, centre, 1.0F)};
  }
  NodeVisibility judge_children(unsigned depth, const Eigen::Vector3d& centre, float enlarged) const {
    return judge(offsets_.centres<Float8>(depth, centre), offsets_.half_extent(depth) * enlarged, camera_,
                 config_.max_range_m, pyramid_);
  }

  /// Returns the node's new state.
  Slot update(Slot node, unsigned depth, const Cell& cell) {
    const ChildHits hits(cell.hits, depth + 1);
    InnerBlock made;
    if (!node.is_block()) made = opened(node);
    InnerBlock& block = node.is_block() ? tree_.inner(node) : made;
    const unsigned saturated = saturated_free(block);
    unsigned free = cell.children.free & ~hits.mask & ~saturated;
    unsigned split =
        hits.mask |
        (0xFFU & ~(cell.children.nothing | cell.children.free | (cell.children.part_free & saturated)));
    if ((free | split) == 0) return node;

    prefetch_children(block, free | split);
    unsigned clear = free;
    if (const unsigned in_doubt = free == 0 ? 0 : free & blocks_in(block); in_doubt != 0) {
      clear &= ~in_doubt | judge_children(depth, cell.centre, kClearance).free;
      const unsigned inner = free & ~clear & ~leaf_blocks_in(block);
      split |= inner;
      free &= ~inner;
    }
    for (unsigned open = free; open != 0; open &= open - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(open));
      const double z_m = cell.centre.z() + offsets_.to_child(depth, i).z();
      const float weight = weight_at(config_.noise, static_cast<float>(z_m));
      block.slots[i] = mark_free(block.slots[i], depth + 1, weight, (clear >> i & 1U) != 0);
    }
    if (depth + 1 == kLeafDepth - 1) {
      update_leaves(voxels_, block, split, depth, cell, hits);
    } else {
      const unsigned coarse = depth + 1 == kCoarseDepth ? coarse_of(block, split, cell) : 0;
      update_leaves(coarse_cells_, block, coarse, depth, cell, hits);
      update_children(block, split & ~coarse, depth, cell, hits);
    }
    return branches_ != nullptr && depth < kBranchDepth ? tree_.kept_open(node, block)
                                                        : tree_.prune(node, block);
  }

  void update_branches(std::span<const Cell> branches, unsigned threads) {
    parallel_for(branches.size(), threads, [&](std::size_t i, unsigned thread) {
      pool_lane = thread;
      Slot& slot = slot_of(branches[i].code);
      slot = update(slot, kBranchDepth, branches[i]);
    });
  }

  // Returns the node at kBranchDepth with a Morton code. All nodes above it must be inner blocks.
  Slot& slot_of(std::uint64_t code) {
    Slot* slot = &tree_.root;
    for (unsigned depth = 0; depth < kBranchDepth; ++depth)
      slot = &tree_.inner(*slot).slots[code >> 3U * (kBranchDepth - 1 - depth) & 7U];
    return *slot;
  }

  Slot prune_above_branches(Slot node, unsigned depth) {
    if (!node.is_inner_block() || depth == kBranchDepth) return node;
    InnerBlock& block = tree_.inner(node);
    for (Slot& slot : block.slots) slot = prune_above_branches(slot, depth + 1);
    return tree_.prune(node, block);
  }

  // Returns those children in `split`, at kCoarseDepth, whose cells are coarse. Refines coarse cells that are
  // near now.
  unsigned coarse_of(InnerBlock& block, unsigned split, const Cell& cell) {
    unsigned coarse = 0;
    for (unsigned open = split; open != 0; open &= open - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(open));
      Slot& child = block.slots[i];
      const double z_m = cell.centre.z() + offsets_.to_child(kCoarseDepth - 1, i).z();
      const bool is_far = z_m >= static_cast<double>(coarse_from_m_);
      if (is_far && may_be_coarse(tree_, child))
        coarse |= 1U << i;
      else if (child.is_leaf_block())
        child = refined(tree_, child);
    }
    return coarse;
  }

  // All children are classified before the first is changed, so the CPU overlaps their memory accesses.
  void update_children(InnerBlock& block, unsigned split, unsigned depth, const Cell& cell,
                       const ChildHits& hits) {
    std::array<Cell, 8> cells;
    for (unsigned open = split; open != 0; open &= open - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(open));
      cells[i] =
          cell_at(depth + 1, cell.centre + offsets_.to_child(depth, i), cell.code << 3U | i, hits.in[i]);
    }
    for (unsigned open = split; open != 0; open &= open - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(open));
      if (branches_ != nullptr && depth + 1 == kBranchDepth)
        branches_->push_back(cells[i]);
      else
        block.slots[i] = update(block.slots[i], depth + 1, cells[i]);
    }
  }
  // Updates the children in `split` as leaf blocks. `depth` is that of their parent.
  void update_leaves(LeafUpdate<Float8>& leaves, InnerBlock& block, unsigned split, unsigned depth,
                     const Cell& cell, const ChildHits& hits) {
    std::array<Observed<Float8>, 8> observed;
    for (unsigned open = split; open != 0; open &= open - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(open));
      const Eigen::Vector3d centre = cell.centre + offsets_.to_child(depth, i);
      observed[i] = leaves.observe(offsets_.centres<Float8>(depth + 1, centre));
    }
    for (unsigned open = split; open != 0; open &= open - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(open));
      const unsigned hit = hit_cells(hits.in[i], depth + 1);
      block.slots[i] = leaves.update(block.slots[i], observed[i], hit, is_colours_turn(cell.code << 3U | i));
    }
  }

  // Returns the cells (bit i: cell i) of a leaf block at `depth` in which rays end.
  static unsigned hit_cells(HitRange hits, unsigned depth) {
    if (depth == kLeafDepth - 1) return hits.empty() ? 0 : hits.front().voxels();
    unsigned cells = 0;
    for (const BlockHits& hit : hits) cells |= 1U << hit.child(depth + 1);
    return cells;
  }

  // Marks a node that is wholly seen through; clear: the space around it is seen through, too.
  Slot mark_free(Slot node, unsigned depth, float weight, bool clear) {
    if (!node.is_block()) return voxels_.missed(node);
    if (node.is_leaf_block())
      return (depth == kCoarseDepth ? coarse_cells_ : voxels_).mark_free(node, weight, clear);
    InnerBlock& block = tree_.inner(node);
    prefetch_children(block, 0xFFU);
    for (Slot& slot : block.slots) slot = mark_free(slot, depth + 1, weight, clear);
    return tree_.prune(node, block);
  }

  static unsigned blocks_in(const InnerBlock& block) {
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i) bits |= static_cast<unsigned>(block.slots[i].is_block()) << i;
    return bits;
  }
  static unsigned leaf_blocks_in(const InnerBlock& block) {
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i) bits |= static_cast<unsigned>(block.slots[i].is_leaf_block()) << i;
    return bits;
  }
  [[nodiscard]] unsigned saturated_free(const InnerBlock& block) const {
    const Slot saturated = voxels_.saturated_free();
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i) bits |= static_cast<unsigned>(block.slots[i] == saturated) << i;
    return bits;
  }

  // True in one frame of sixteen, in which even a colour of much weight is updated; the phase differs between
  // blocks.
  [[nodiscard]] bool is_colours_turn(std::uint64_t code) const {
    return (((code * 0x9E37'79B9'7F4A'7C15U) >> 60U) + frame_index_) % 16 == 0;
  }

  void prefetch_children(const InnerBlock& block, unsigned which) const {
    for (; which != 0; which &= which - 1) {
      const Slot child = block.slots[static_cast<unsigned>(std::countr_zero(which))];
      if (!child.is_block()) continue;
      if (child.is_leaf_block())
        __builtin_prefetch(&tree_.leaves(child), 1);
      else
        __builtin_prefetch(&tree_.inner(child), 1);
    }
  }

  BlockOctree& tree_;
  const FusionConfig& config_;
  const DepthPyramid& pyramid_;
  Pinhole camera_;
  ChildOffsets offsets_;
  LeafUpdate<Float8> voxels_, coarse_cells_;
  float coarse_from_m_;
  std::uint64_t frame_index_;
  std::vector<Cell>* branches_ = nullptr;  // not null: nodes at kBranchDepth are collected, not updated
};

template <typename Float8>
void descend(BlockOctree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
             const FusionConfig& config, const FusionScratch& scratch, unsigned threads) {
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  const Eigen::Vector3d world_origin = T_camera_world.translation();  // centre of the tree
  Descent<Float8>(tree, frame, T_camera_world, config, scratch.pyramid)
      .run(world_origin, scratch.hits, threads);
}

}  // namespace

void fuse_depth(BlockOctree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                const FusionConfig& config, const FusionScratch& scratch, const FusionExecution& execution) {
  if (execution.arithmetic == Arithmetic::kFastest)
    descend<Float8>(tree, frame, T_world_camera, config, scratch, execution.threads);
  else
    descend<PortableFloat8>(tree, frame, T_world_camera, config, scratch, execution.threads);
}

}  // namespace roomradar
