// fusion.cpp: the descent that fuses one depth frame.
#include "mapping/fusion.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "mapping/fusion_leaves.hpp"
#include "mapping/fusion_view.hpp"

namespace roomradar {
namespace {

using HitRange = std::span<const BlockHits>;

// Splits off the hits in child i of a node at depth - 1, which come first.
HitRange take_front(HitRange& hits, unsigned depth, unsigned i) {
  if (hits.empty() || hits.front().child(depth) != i) return {};
  const auto end = std::partition_point(hits.begin(), hits.end(),
                                        [&](const BlockHits& hit) { return hit.child(depth) == i; });
  const HitRange taken = hits.first(static_cast<std::size_t>(end - hits.begin()));
  hits = hits.subspan(taken.size());
  return taken;
}

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
        leaves_(tree, frame, config),
        frame_index_(static_cast<std::uint64_t>(frame.index)) {}

  /// What a node has become. centre: of the node, in the camera frame, m; code: its Morton code.
  Slot update(Slot node, unsigned depth, const Eigen::Vector3d& centre, std::uint64_t code, HitRange hits) {
    const EightPoints<Float8> centres = offsets_.centres<Float8>(depth, centre);
    if (depth == kLeafDepth - 1)
      return leaves_.update(node, centres, hits.empty() ? 0 : hits.front().voxels(), is_colours_turn(code));

    std::array<HitRange, 8> hits_in;
    unsigned hit = 0;
    for (unsigned i = 0; i < 8 && !hits.empty(); ++i) {
      hits_in[i] = take_front(hits, depth + 1, i);
      hit |= hits_in[i].empty() ? 0 : 1U << i;
    }
    InnerBlock made;
    if (!node.is_block()) made = opened(node);
    InnerBlock& block = node.is_block() ? tree_.inner(node) : made;
    const unsigned settled = settled_free(block);
    const Verdicts verdicts =
        judge(centres, offsets_.half_extent(depth), camera_, config_.max_range_m, pyramid_);
    const unsigned free = verdicts.free & ~hit & ~settled;
    const unsigned nothing = verdicts.nothing | verdicts.free | (verdicts.part_free & settled);
    const unsigned split = hit | (0xFFU & ~nothing);
    if ((free | split) == 0) return node;

    prefetch_children(block, free | split, depth + 1);
    for (unsigned open = free; open != 0; open &= open - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(open));
      const double z_m = centre.z() + offsets_.to_child(depth, i).z();
      const float sigma_m = depth_sigma_m(static_cast<float>(z_m));
      block.slots[i] = mark_free(block.slots[i], depth + 1, weight_of_sigma(sigma_m, depth_sigma_m(1.0F)));
    }
    for (unsigned open = split; open != 0; open &= open - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(open));
      block.slots[i] =
          update(block.slots[i], depth + 1, centre + offsets_.to_child(depth, i), code << 3U | i, hits_in[i]);
    }
    return tree_.settle(node, block);
  }

 private:
  /// The whole node is seen through.
  Slot mark_free(Slot node, unsigned depth, float weight) {
    if (!node.is_block()) return leaves_.missed(node);
    if (depth == kLeafDepth - 1) return leaves_.mark_free(node, weight);
    InnerBlock& block = tree_.inner(node);
    prefetch_children(block, 0xFFU, depth + 1);
    for (Slot& slot : block.slots) slot = mark_free(slot, depth + 1, weight);
    return tree_.settle(node, block);
  }

  [[nodiscard]] unsigned settled_free(const InnerBlock& block) const {
    const Slot settled = leaves_.settled_free();
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i) bits |= static_cast<unsigned>(block.slots[i] == settled) << i;
    return bits;
  }

  // A settled colour is looked at by one frame in sixteen; which one, differs from block to block.
  [[nodiscard]] bool is_colours_turn(std::uint64_t code) const {
    return (((code * 0x9E37'79B9'7F4A'7C15U) >> 60U) + frame_index_) % 16 == 0;
  }

  void prefetch_children(const InnerBlock& block, unsigned which, unsigned depth) const {
    for (; which != 0; which &= which - 1) {
      const Slot child = block.slots[static_cast<unsigned>(std::countr_zero(which))];
      if (!child.is_block()) continue;
      if (depth == kLeafDepth - 1)
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
  LeafUpdate<Float8> leaves_;
  std::uint64_t frame_index_;
};

template <typename Float8>
void descend(BlockOctree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
             const FusionConfig& config, const FusionScratch& scratch) {
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  const Eigen::Vector3d root_centre =
      T_camera_world.translation();  // the world's origin is the tree's middle
  Descent<Float8> descent(tree, frame, T_camera_world, config, scratch.pyramid);
  tree.root = descent.update(tree.root, 0, root_centre, 0, scratch.hits);
}

}  // namespace

void fuse_depth(BlockOctree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                const FusionConfig& config, FusionScratch& scratch, Arithmetic arithmetic) {
  build_pyramid(frame.depth_m, tree.resolution_m(), config, scratch.pyramid);
  if (arithmetic == Arithmetic::kFastest)
    descend<Float8>(tree, frame, T_world_camera, config, scratch);
  else
    descend<PlainFloat8>(tree, frame, T_world_camera, config, scratch);
}

}  // namespace roomradar
