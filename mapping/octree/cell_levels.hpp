// cell_levels.hpp: cells of two sizes. A cell is a voxel (fine) where a frame measured the surface at close
// range. Where only frames from farther away measured it, a cell is coarse: its edge is two voxels, and it
// represents eight voxels. Close frames refine coarse cells. Fine cells never become coarse. Private to
// StaticMap.
#pragma once
#include <array>
#include <cstdint>

#include "mapping/octree/block_octree.hpp"

namespace roomradar {

/// Returns the depth, m, from which on frames write coarse cells. At this depth, the standard deviation of
/// depth is a coarse cell's edge divided by FusionConfig::max_cell_sigmas. Infinite if the depth is beyond
/// max_range_m, or if max_cell_sigmas is 0.
float coarse_from_m(double resolution_m, const FusionConfig& config);

/// The six face neighbours of a node, as nodes of the same size. Index 2 axis is the lower side, 2 axis + 1
/// the upper side. A neighbour is unknown if the octree has no node of that size.
using Sides = std::array<Slot, 6>;
/// Returns the sides of child i of a node with the children `block` and the sides `of_parent`.
Sides sides_of_child(const BlockOctree& tree, const InnerBlock& block, const Sides& of_parent, unsigned i);

/// Returns the signed distances of the eight voxels in cell i of a coarse leaf block, in units of
/// BlockUnits::distance_m. Distances are interpolated linearly between the cell and its neighbours along each
/// axis, and extrapolated where a neighbour has no signed distance.
std::array<std::int16_t, 8> voxel_distances(const BlockOctree& tree, const LeafBlock& coarse,
                                            const Sides& sides, unsigned i);

/// Replaces a coarse leaf block by the voxels that it represents. Each voxel has its cell's log-odds, weight
/// and colour. Distances are interpolated within the block. Samples in front of a surface are dropped outside
/// the truncation band of voxels, which is narrower than that of coarse cells. Otherwise close frames would
/// have to correct such samples. Samples behind the surface are kept, since on a surface seen obliquely even
/// adjacent samples are outside the band. Returns the node's new state.
Slot refined(OctreeWriter tree, Slot node);

/// Returns true if a node at kCoarseDepth has no fine samples, so that its cells may be coarse: it is not an
/// inner block, or has no child that is a block.
bool may_be_coarse(const BlockOctree& tree, Slot node);
/// Returns the cells of a node for which may_be_coarse() holds and that has no leaf block.
LeafBlock opened_coarse(const BlockOctree& tree, Slot node);
/// Stores the changed cells of a node for which may_be_coarse() holds, and returns the node's new state.
/// Cells without any sample become cubes. If the node has a leaf block, `block` must be that block.
Slot prune_coarse(OctreeWriter tree, Slot node, const LeafBlock& block);

/// Calls change(LeafBlock&) on the eight voxels of a node at depth 15. Splits the node first if it is not a
/// block. Returns the node's new state after pruning.
template <typename Change>
Slot change_leaves(OctreeWriter tree, Slot node, const Change& change) {
  LeafBlock made;
  if (!node.is_block()) made = opened_leaves(node);
  LeafBlock& block = node.is_block() ? tree.leaves(node) : made;
  change(block);
  return tree.prune(node, block);
}

/// Replaces the state of the node at `target` by change(state), and creates the nodes between `node` and
/// `target`. Refines coarse cells above `target`. `place` is the location of `node`; `target` must be in its
/// subtree. Returns the new state of `node` after pruning.
template <typename Change>
Slot change_node(OctreeWriter tree, Slot node, const NodePlace& place, const NodePlace& target,
                 const Change& change) {
  if (place.depth == target.depth) return change(node);
  if (node.is_leaf_block()) node = refined(tree, node);
  InnerBlock made;
  if (!node.is_block()) made = opened(node);
  InnerBlock& block = node.is_block() ? tree.inner(node) : made;
  const unsigned i = place.towards(target.key);
  block.slots[i] = change_node(tree, block.slots[i], place.child(i), target, change);
  return tree.prune(node, block);
}

/// Calls visit(place, block, sides, i) in Morton order for each cell that has a signed distance and a voxel
/// in the range: cell i of the leaf block `block` at `place`. The parameters `sides` and `place` describe
/// `node`; visit() receives those of the leaf block.
template <typename Visit>
void for_each_cell(const BlockOctree& tree, Slot node, const Sides& sides, const NodePlace& place,
                   const KeyRange& range, const Visit& visit) {
  if (!node.is_block() || !range.meets(place)) return;
  if (node.is_leaf_block()) {
    const LeafBlock& block = tree.leaves(node);
    for (unsigned i = 0; i < 8; ++i)
      if (block.weight[i] != 0 && range.meets(place.child(i))) visit(place, block, sides, i);
    return;
  }
  const InnerBlock& block = tree.inner(node);
  for (unsigned i = 0; i < 8; ++i)
    for_each_cell(tree, block.slots[i], sides_of_child(tree, block, sides, i), place.child(i), range, visit);
}

}  // namespace roomradar
