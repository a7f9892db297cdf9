// block_octree.hpp: octree into which depth frames are fused. Private to StaticMap. Keys, depth, log-odds and
// pruning are OctoMap's, and static_map_file.cpp writes the octree in OctoMap's file formats. Eight siblings
// share one block of one cache line, where OctoMap makes nine separate allocations. Fusing a frame changes
// about 50,000 groups of eight voxels, and memory access dominates the time.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "mapping/octree/fusion_config.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/system/block_pool.hpp"

namespace roomradar {

inline constexpr unsigned kLeafDepth = 16;    // depth of the voxels, as in OctoMap, whose keys have 16 bits
inline constexpr unsigned kCoarseDepth = 14;  // depth of nodes whose leaf block has coarse cells
inline constexpr int kKeyOrigin = 32768;      // key of the voxel whose lower corner is at the world's origin

/// Log-odds in units of BlockUnits::log_odds; 0 means unknown. A known voxel whose log-odds round to 0 stores
/// 1, since OctoMap treats a probability of one half as occupied.
using LogOdds = std::int16_t;

/// State of a node: unknown, a cube (uniform log-odds, no children), an inner block (eight child nodes), or a
/// leaf block (eight cells).
class Slot {
 public:
  Slot() = default;
  static Slot cube(LogOdds log_odds) {
    return log_odds == 0 ? Slot() : Slot(kCube | static_cast<std::uint16_t>(log_odds));
  }
  static Slot inner_block(std::uint32_t number) { return Slot(number); }
  static Slot leaf_block(std::uint32_t number) { return Slot(kLeaf | number); }

  [[nodiscard]] bool is_unknown() const { return bits_ == 0; }
  [[nodiscard]] bool is_cube() const { return (bits_ & kCube) != 0; }
  [[nodiscard]] bool is_block() const { return bits_ != 0 && !is_cube(); }
  [[nodiscard]] bool is_leaf_block() const { return (bits_ & (kCube | kLeaf)) == kLeaf; }
  [[nodiscard]] bool is_inner_block() const { return bits_ != 0 && (bits_ & (kCube | kLeaf)) == 0; }
  /// Returns the log-odds of a cube; 0 if unknown.
  [[nodiscard]] LogOdds log_odds() const { return static_cast<LogOdds>(static_cast<std::uint16_t>(bits_)); }
  /// Returns the number of a leaf block in the pool of leaf blocks, or of an inner block in its pool.
  [[nodiscard]] std::uint32_t number() const { return bits_ & ~kLeaf; }
  friend bool operator==(const Slot&, const Slot&) = default;

 private:
  static constexpr std::uint32_t kCube = 1U << 31U, kLeaf = 1U << 30U;
  explicit Slot(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_ = 0;
};

/// The eight children of a node above depth 15. The child index is OctoMap's: x has weight 1, y 2, z 4.
struct alignas(32) InnerBlock {
  std::array<Slot, 8> slots;
};
static_assert(sizeof(InnerBlock) == 32);

/// The eight cells of a node. At depth 15, the cells are voxels. At depth 14, they are coarse cells with an
/// edge of two voxels (cell_levels.hpp), of which at least one has a signed distance. A cell behind a surface
/// may have a signed distance although its occupancy is unknown.
struct alignas(64) LeafBlock {
  std::array<LogOdds, 8> log_odds{};
  std::array<std::int16_t, 8> distance{};  ///< signed distance, in units of BlockUnits::distance_m
  std::array<std::uint16_t, 8> weight{};   ///< weight, in units of BlockUnits::weight; 0: no signed distance
  std::uint32_t colours = 0;               ///< number of the cells' ColourBlock; 0: none
  std::uint8_t coloured = 0;               ///< bit i: cell i has a colour

  [[nodiscard]] bool holds(unsigned i) const { return log_odds[i] != 0 || weight[i] != 0; }
  [[nodiscard]] bool has_samples() const {
    const auto words = std::bit_cast<std::array<std::uint64_t, 2>>(weight);
    return (words[0] | words[1]) != 0;
  }
};
static_assert(sizeof(LeafBlock) == 64);

/// Colours of a leaf block's cells, stored separately because most blocks have none or rarely update them.
struct ColourBlock {
  std::array<Rgb, 8> colours;
};

/// Step sizes of the integers in the blocks, such that 15 or 16 bits cover the range that the config allows.
/// With default settings and 1 cm voxels, the steps are 1e-4 for log-odds, 3 micrometres for distance, and
/// half the weight of a frame at 5 m for weight.
struct BlockUnits {
  BlockUnits() = default;
  BlockUnits(double resolution_m, const FusionConfig& config);
  float log_odds = 0.0F;
  float distance_m = 0.0F;
  float weight = 0.0F;
};

/// Location of a node in the tree: its depth, and the key (kKeyOrigin + voxel index) of its lowest voxel.
struct NodePlace {
  unsigned depth = 0;
  Eigen::Array3i key = Eigen::Array3i::Zero();

  [[nodiscard]] int edge_voxels() const { return 1 << (kLeafDepth - depth); }
  [[nodiscard]] NodePlace child(unsigned i) const {
    const int edge = edge_voxels() / 2;
    return {depth + 1, key + Eigen::Array3i(i & 1U ? edge : 0, i & 2U ? edge : 0, i & 4U ? edge : 0)};
  }
  /// Returns the index of the child that contains a voxel.
  [[nodiscard]] unsigned towards(const Eigen::Array3i& voxel_key) const {
    const auto digit = [&](int axis) {
      return static_cast<unsigned>(voxel_key[axis] >> (kLeafDepth - 1 - depth)) & 1U;
    };
    return digit(0) | digit(1) << 1U | digit(2) << 2U;
  }
};

/// Range of the keys of all voxels whose centres are in a box.
struct KeyRange {
  Eigen::Array3i first = Eigen::Array3i::Zero();
  Eigen::Array3i last = Eigen::Array3i::Constant(65535);

  [[nodiscard]] bool holds(const Eigen::Array3i& key) const {
    return (key >= first).all() && (key <= last).all();
  }
  [[nodiscard]] bool meets(const NodePlace& place) const {
    return (place.key <= last).all() && (place.key + (place.edge_voxels() - 1) >= first).all();
  }
};
/// Returns the range for a box in the world frame, m. The range has no keys if the box is empty.
KeyRange keys_in(const Eigen::AlignedBox3d& box_world, double resolution_m);

class BlockOctree {
 public:
  BlockOctree(double resolution_m, const FusionConfig& config);

  [[nodiscard]] double resolution_m() const { return resolution_m_; }
  [[nodiscard]] const BlockUnits& units() const { return units_; }
  /// Returns the truncation distance at the smallest measured depth for which cells are coarse, in units of
  /// BlockUnits::distance_m.
  [[nodiscard]] int voxel_band() const { return voxel_band_; }
  [[nodiscard]] std::size_t memory_bytes() const {
    return inner_.memory_bytes() + leaves_.memory_bytes() + colours_.memory_bytes();
  }

  Slot root;

  InnerBlock& inner(Slot slot) { return inner_[slot.number()]; }
  const InnerBlock& inner(Slot slot) const { return inner_[slot.number()]; }
  LeafBlock& leaves(Slot slot) { return leaves_[slot.number()]; }
  const LeafBlock& leaves(Slot slot) const { return leaves_[slot.number()]; }
  [[nodiscard]] Rgb colour(const LeafBlock& block, unsigned i) const {
    return (block.coloured >> i & 1U) != 0 ? colours_[block.colours].colours[i] : Rgb{};
  }

  /// Call after several threads have changed the octree; see BlockPool::gather_free().
  void gather_free() { inner_.gather_free(), leaves_.gather_free(), colours_.gather_free(); }

 private:
  friend class OctreeWriter;

  double resolution_m_;
  BlockUnits units_;
  int voxel_band_;
  BlockPool<InnerBlock> inner_;
  BlockPool<LeafBlock> leaves_;
  BlockPool<ColourBlock> colours_;
};

/// Changes an octree with the blocks of one lane. A copy refers to the same octree and lane. Threads that
/// change an octree concurrently need writers of different lanes, and must not change the same node.
class OctreeWriter {
 public:
  /// Implicit: one thread alone uses the first lane.
  OctreeWriter(BlockOctree& tree) : OctreeWriter(tree, 0) {}
  OctreeWriter(BlockOctree& tree, unsigned lane) : tree_(&tree), lane_(lane) {}

  [[nodiscard]] BlockOctree& tree() const { return *tree_; }
  operator const BlockOctree&() const { return *tree_; }
  [[nodiscard]] double resolution_m() const { return tree_->resolution_m(); }
  [[nodiscard]] const BlockUnits& units() const { return tree_->units(); }
  [[nodiscard]] InnerBlock& inner(Slot slot) const { return tree_->inner(slot); }
  [[nodiscard]] LeafBlock& leaves(Slot slot) const { return tree_->leaves(slot); }
  /// Returns the block's colours; allocates them if the block has none.
  ColourBlock& colours(LeafBlock& block) const {
    if (block.colours == 0) block.colours = tree_->colours_.take(lane_);
    return tree_->colours_[block.colours];
  }

  /// Prunes `node`, whose children are `block`, and returns the node's new state. If all eight children are
  /// unknown or equal cubes without a signed distance, the node's block is freed and the node becomes unknown
  /// or a cube. Otherwise, a node that is a block is returned unchanged; `block` must be its own block. For
  /// any other node, allocates a new block with a copy of `block`.
  Slot prune(Slot node, const InnerBlock& block) const {
    if (alike(block)) {
      if (node.is_block()) tree_->inner_.give_back(node.number(), lane_);
      return block.slots[0];
    }
    return kept_open(node, block);
  }
  Slot prune(Slot node, const LeafBlock& block) const {
    if (alike(block)) {
      const Slot merged = Slot::cube(block.log_odds[0]);
      free_leaves(node, block);
      return merged;
    }
    if (node.is_block()) return node;
    const Slot kept = Slot::leaf_block(tree_->leaves_.take(lane_));
    leaves(kept) = block;
    return kept;
  }

  /// Frees the colours of `block`, and the leaf block of `node` if it has one.
  void free_leaves(Slot node, const LeafBlock& block) const {
    if (block.colours != 0) tree_->colours_.give_back(block.colours, lane_);
    if (node.is_leaf_block()) tree_->leaves_.give_back(node.number(), lane_);
  }
  /// Frees the inner block of `node`, whose children must not be blocks.
  void free_inner(Slot node) const { tree_->inner_.give_back(node.number(), lane_); }
  /// Returns a node with the children `block`, without pruning.
  Slot kept_open(Slot node, const InnerBlock& block) const {
    if (node.is_block()) return node;
    const Slot kept = Slot::inner_block(tree_->inner_.take(lane_));
    inner(kept) = block;
    return kept;
  }

 private:
  // Returns true if all children are unknown, or all are equal cubes. Children that are blocks never compare
  // equal, since no two nodes share a block.
  static bool alike(const InnerBlock& block) {
    bool same = true;
    for (const Slot slot : block.slots) same &= slot == block.slots[0];
    return same;
  }
  static bool alike(const LeafBlock& block) {
    using Words = std::array<std::uint64_t, 2>;
    const auto weight = std::bit_cast<Words>(block.weight), log_odds = std::bit_cast<Words>(block.log_odds);
    const std::uint64_t first = static_cast<std::uint16_t>(block.log_odds[0]) * 0x0001'0001'0001'0001U;
    return (weight[0] | weight[1] | (log_odds[0] ^ first) | (log_odds[1] ^ first)) == 0;
  }

  BlockOctree* tree_;
  unsigned lane_;
};

/// Returns true if a cube of these log-odds may result from a sensor's measurements. Free cubes have an edge
/// of at most 8,192 voxels. Occupied cubes have an edge of at most 4 m, since sensors observe only the
/// surface of solids. Larger cubes mean a damaged file. The limits also bound loops over the voxels of a
/// cube.
bool is_plausible_cube(const BlockOctree& tree, LogOdds log_odds, unsigned depth);

struct SubtreeSize {
  std::size_t nodes = 0;  ///< number of nodes that OctoMap's file formats store
  std::size_t bytes = 0;  ///< memory of the blocks in use, including colours
};
/// Returns the size of a node with all its descendants.
SubtreeSize size_of(const BlockOctree& tree, Slot node, unsigned depth);

/// Erases the signed distance and colour of cell i.
inline void erase_sample(LeafBlock& block, unsigned i) {
  block.weight[i] = 0;
  block.distance[i] = 0;
  block.coloured &= static_cast<std::uint8_t>(~(1U << i));
}

/// Returns the eight children of a node that is not a block; each equals the node.
inline InnerBlock opened(Slot node) {
  InnerBlock block;
  block.slots.fill(node);
  return block;
}
inline LeafBlock opened_leaves(Slot node) {
  LeafBlock block;
  block.log_odds.fill(node.log_odds());
  return block;
}

/// Visits a node's subtree in Morton order. Calls on_cube(place, log-odds) for each cube, and
/// on_leaves(place, LeafBlock) for each leaf block; cell i of the block is the node place.child(i).
template <typename OnCube, typename OnLeaves>
void for_each_part(const BlockOctree& tree, Slot node, const NodePlace& place, const OnCube& on_cube,
                   const OnLeaves& on_leaves) {
  if (node.is_unknown()) return;
  if (node.is_cube()) return on_cube(place, node.log_odds());
  if (node.is_leaf_block()) return on_leaves(place, tree.leaves(node));
  const InnerBlock& block = tree.inner(node);
  for (unsigned i = 0; i < 8; ++i) for_each_part(tree, block.slots[i], place.child(i), on_cube, on_leaves);
}

/// Calls visit(place, log-odds) for each free or occupied leaf, of any size, in Morton order.
template <typename Visit>
void for_each_leaf(const BlockOctree& tree, const Visit& visit) {
  for_each_part(tree, tree.root, {}, visit, [&](const NodePlace& place, const LeafBlock& block) {
    for (unsigned i = 0; i < 8; ++i)
      if (block.log_odds[i] != 0) visit(place.child(i), block.log_odds[i]);
  });
}

}  // namespace roomradar
