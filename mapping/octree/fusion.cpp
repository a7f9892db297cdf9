// fusion.cpp: the octree descent that fuses one depth frame; range checks of the settings.
#include "mapping/octree/fusion.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/cell_levels.hpp"
#include "mapping/octree/node_visibility.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/fibonacci_hash.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/simd8f.hpp"
#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

/// Returns the weight of a measurement: kUnitWeightSigma_m squared divided by the measurement's variance, at
/// most 1.
inline float weight_at(const DepthNoise& noise, float depth_m) {
  const float ratio = kUnitWeightSigma_m / depth_sigma_m(noise, depth_m);
  return std::min(ratio * ratio, 1.0F);
}

/// Edge of the cells that an update changes.
enum class CellSize { kVoxel, kCoarse };

/// Measurements of eight cells, each from the pixel to which the cell's centre projects.
template <typename Float8>
struct Observed {
  EightPoints<Float8> p_camera;  ///< centres of the cells, m
  Float8 distance_m;             ///< measured depth minus depth of the cell's centre
  Float8 sigma_m;                ///< standard deviation of the measured depth
  unsigned free = 0;             ///< bit i: the frame sees through the centre of cell i
  unsigned sampled = 0;          ///< bit i: the centre of cell i is within the truncation band
};

/// Updates leaf blocks of one cell size with one frame. The sample of a cell is its signed distance, weight
/// and colour.
template <typename Float8>
class LeafUpdate {
 public:
  LeafUpdate(OctreeWriter tree, const Frame& frame, const FusionConfig& config, CellSize size)
      : tree_(tree),
        frame_(frame),
        config_(config),
        size_(size),
        cell_m_(static_cast<float>(tree.resolution_m()) * (size == CellSize::kCoarse ? 2.0F : 1.0F)),
        camera_(frame.depth_camera),
        colour_camera_(frame.colour_camera),
        T_colour_depth_(frame.T_colour_depth.cast<float>().matrix()),
        truncation_m_(config.truncation_voxels * cell_m_),
        colour_distance_m_(kColourCells * cell_m_),
        behind_(-kBehind_cells * cell_m_ / tree.units().distance_m),
        log_odds_{in_steps(config.hit_log_odds), in_steps(config.miss_log_odds),
                  in_steps(config.min_log_odds), in_steps(config.max_log_odds)} {
    const ColourImage& colour = frame.colour;
    has_colour_ = !colour.empty() && colour.width == frame.colour_camera.width_px &&
                  colour.height == frame.colour_camera.height_px;
  }

  /// Makes the updates with another writer of the same octree.
  void write_with(OctreeWriter tree) { tree_ = tree; }

  /// Returns a free cube at the minimum log-odds; further misses do not change it.
  [[nodiscard]] Slot saturated_free() const { return Slot::cube(static_cast<LogOdds>(log_odds_.min)); }
  /// Returns the cube's state after one miss.
  [[nodiscard]] Slot missed(Slot cube) const {
    const float after = std::max(static_cast<float>(cube.log_odds()) + log_odds_.miss, log_odds_.min);
    return Slot::cube(static_cast<LogOdds>(after == 0.0F ? 1.0F : after));
  }

  /// Looks up the pixel to which each point projects. Pixels without depth set no bits.
  [[nodiscard]] Observed<Float8> observe(const EightPoints<Float8>& p_camera) const {
    const Float8 inverse_z = Float8(1.0F) / p_camera.z;
    const Float8 u = floor(p_camera.x * camera_.fx * inverse_z + (camera_.cx + 0.5F));
    const Float8 v = floor(p_camera.y * camera_.fy * inverse_z + (camera_.cy + 0.5F));
    const auto seen = (Float8(kNearest_m) < p_camera.z) & (Float8(0.0F) <= u) & (u < camera_.width) &
                      (Float8(0.0F) <= v) & (v < camera_.height);
    const Float8 depth_m = Float8::gather(frame_.depth_m.pixels.data(), v * camera_.width + u, seen);
    const auto measured = Float8(kLeastDepth_m) <= depth_m;
    const Float8 distance_m = depth_m - p_camera.z;
    const Float8 sigma_m = depth_sigmas_m(config_.noise, depth_m);
    const auto free = measured & (p_camera.z < min(depth_m, config_.max_range_m));
    const auto sampled = measured & (depth_m <= config_.max_range_m) &
                         (abs(distance_m) <= max(truncation_m_, sigma_m * config_.truncation_sigmas));
    return {p_camera, distance_m, sigma_m, free.bits(), sampled.bits()};
  }

  /// Updates the eight cells of `node`, and returns the node's new state. With coarse cells, may_be_coarse()
  /// must hold for the node.
  /// @param hit  bit i: a ray ends in cell i
  /// @param refresh_colour  true: also updates colours of cells for which this frame's fraction of the weight
  ///                        is below kMinColourFraction
  Slot update(Slot node, const Observed<Float8>& observed, unsigned hit, bool refresh_colour) {
    const unsigned missed = observed.free & ~hit;
    unsigned sampled = observed.sampled;
    if ((hit | missed | sampled) == 0) return node;
    if ((hit | sampled) == 0 && node == saturated_free()) return node;
    LeafBlock made;
    if (!node.is_leaf_block()) made = opened(node);
    LeafBlock& block = node.is_leaf_block() ? tree_.leaves(node) : made;
    if ((hit | missed) != 0) add_log_odds(block, hit, missed);
    if (const unsigned gone = missed & seen_through(block, observed); gone != 0)
      sampled &= ~cancel_samples(block, weight_of(observed.sigma_m), gone);
    if (sampled != 0) add_samples(block, observed, sampled, refresh_colour);
    return pruned(node, block);
  }

  /// Adds a miss to all voxels of a block, after a frame of this weight saw through all of them. With
  /// `clear`, the frame also saw through the space around the block. Then each sample's distance is averaged
  /// with the truncation distance. The sample is erased once its voxel has the minimum log-odds and its
  /// distance exceeds 0.7 of the truncation distance. Without samples, the voxels can merge with the free
  /// space around them.
  ///
  /// Without `clear`, most samples are kept. Next to edges and on obliquely seen surfaces, seeing through a
  /// voxel is caused by noise more often than by a change. Samples behind a surface are different: frames see
  /// through them only if the surface has gone. Each such frame subtracts kCancelled times its weight from
  /// the sample's weight. Otherwise an object too close to a wall for `clear` would leave its back side in
  /// the map after it moved away.
  Slot mark_free(Slot node, float weight, bool clear) {
    LeafBlock& block = tree_.leaves(node);
    add_log_odds(block, 0, 0xFFU);
    if (clear)
      fade_samples(block, weight);
    else if (const unsigned gone = behind_surface(block); gone != 0)
      cancel_samples(block, weight, gone);
    return pruned(node, block);
  }

 private:
  [[nodiscard]] LeafBlock opened(Slot node) const {
    return size_ == CellSize::kCoarse ? opened_coarse(tree_, node) : opened_leaves(node);
  }
  [[nodiscard]] Slot pruned(Slot node, const LeafBlock& block) const {
    return size_ == CellSize::kCoarse ? prune_coarse(tree_, node, block) : tree_.prune(node, block);
  }

  // Max distance from the surface, in cells, of samples that take the surface's colour. The colours of mesh
  // vertices are interpolated from these samples only.
  static constexpr float kColourCells = 1.5F;
  // A measurement with less than this fraction of the total weight leaves the colour unchanged, except on a
  // refresh. On a refresh, the measurement is weighted with this fraction. Smaller changes would be lost in
  // rounding to 8 bits.
  static constexpr float kMinColourFraction = 1.0F / 8.0F;

  // Min distance, in cells, at which a sample counts as behind a surface. Frames see past samples nearer to
  // the surface too often, because of noise and pose errors.
  static constexpr float kBehind_cells = 0.5F;
  // A frame that sees through a sample subtracts this many times its own weight from the sample's weight. The
  // factor is above 1, since the first such frames only make the voxel free. Also, an object that was present
  // in half of the frames should disappear.
  static constexpr float kCancelled = 2.0F;

  [[nodiscard]] float in_steps(float log_odds) const { return std::round(log_odds / tree_.units().log_odds); }

  static Float8 weight_of(const Float8& sigma_m) {
    const Float8 ratio = Float8(kUnitWeightSigma_m) / sigma_m;
    return min(ratio * ratio, 1.0F);
  }

  void add_log_odds(LeafBlock& block, unsigned hit, unsigned missed) const {
    const Float8 before = Float8::load(block.log_odds);
    const Float8 after = select(Float8::Mask::of_bits(hit), min(before + log_odds_.hit, log_odds_.max),
                                max(before + log_odds_.miss, log_odds_.min));
    const Float8 known = select(after == Float8(0.0F), 1.0F, after);
    select(Float8::Mask::of_bits(hit | missed), known, before).store_rounded(block.log_odds);
  }

  // Returns the voxels (bit i: voxel i) that have a sample behind a surface and are not occupied. Occupied
  // voxels keep their samples, since ghost removal ignores voxels without samples.
  [[nodiscard]] unsigned behind_surface(const LeafBlock& block) const {
    return ((Float8::load(block.distance) < Float8(behind_)) & (Float8::load(block.log_odds) <= 0.0F)).bits();
  }
  // Returns the voxels of behind_surface() that this frame sees through: its depth exceeds the depth of the
  // voxel's stored surface by more than the truncation distance.
  [[nodiscard]] unsigned seen_through(const LeafBlock& block, const Observed<Float8>& observed) const {
    const Float8 further =
        observed.distance_m * (1.0F / tree_.units().distance_m) - Float8::load(block.distance);
    return behind_surface(block) & (Float8(truncation_m_ / tree_.units().distance_m) < further).bits();
  }

  // Subtracts the weight of a frame that sees through the samples of the voxels in `gone`. Returns the voxels
  // whose samples remain.
  unsigned cancel_samples(LeafBlock& block, const Float8& weight, unsigned gone) const {
    const Float8 own_weight = Float8::load(block.weight);
    const Float8 cancelled = max(weight * (kCancelled / tree_.units().weight), 1.0F);
    select(Float8::Mask::of_bits(gone), max(own_weight - cancelled, 0.0F), own_weight)
        .store_rounded(block.weight);
    const auto kept = Float8(0.0F) < Float8::load(block.weight);
    select(kept, Float8::load(block.distance), 0.0F).store_rounded(block.distance);
    block.coloured &= static_cast<std::uint8_t>(kept.bits());
    return gone & kept.bits();
  }

  void fade_samples(LeafBlock& block, float weight) const {
    const BlockUnits& units = tree_.units();
    const Float8 own_weight = Float8::load(block.weight);
    const Float8 gained(std::max(weight * config_.seen_through_gain / units.weight, 1.0F));
    const Float8 distance = Float8::load(block.distance);
    const Float8 truncation(truncation_m_ / units.distance_m);
    const Float8 sum = own_weight + gained;
    const Float8 further = distance + (max(truncation, distance) - distance) * (gained / sum);
    const auto sampled = Float8(0.0F) < own_weight;
    const auto forgotten = (Float8::load(block.log_odds) <= log_odds_.min) & (truncation * 0.7F < further);
    const auto kept = Float8::Mask::of_bits(sampled.bits() & ~forgotten.bits());
    select(kept, further, 0.0F).store_rounded(block.distance);
    select(kept, sum, 0.0F).store_rounded(block.weight);
    block.coloured &= static_cast<std::uint8_t>(kept.bits());
  }

  void add_samples(LeafBlock& block, const Observed<Float8>& observed, unsigned which, bool refresh_colour) {
    const BlockUnits& units = tree_.units();
    const Float8 own_weight = Float8::load(block.weight);
    const Float8 weight = max(floor(weight_of(observed.sigma_m) * (1.0F / units.weight) + 0.5F), 1.0F);
    const Float8 sum = own_weight + weight;
    const Float8 part = weight / sum;
    const Float8 distance = Float8::load(block.distance);
    const Float8 mean = distance + (observed.distance_m * (1.0F / units.distance_m) - distance) * part;
    const auto sampled = Float8::Mask::of_bits(which);
    select(sampled, mean, distance).store_rounded(block.distance);
    select(sampled, sum, own_weight).store_rounded(block.weight);
    if (!has_colour_) return;
    unsigned take = which & (abs(observed.distance_m) < colour_distance_m_).bits();
    if (!refresh_colour) take &= ~block.coloured | (Float8(kMinColourFraction) <= part).bits();
    if (take != 0) add_colours(block, observed.p_camera, max(part, kMinColourFraction), take);
  }

  void add_colours(LeafBlock& block, const EightPoints<Float8>& p_camera, const Float8& part, unsigned take) {
    const Eigen::Matrix4f& T = T_colour_depth_;
    const auto along = [&](int row) {
      return p_camera.x * T(row, 0) + p_camera.y * T(row, 1) + p_camera.z * T(row, 2) + T(row, 3);
    };
    const Float8 z = along(2);
    const Float8 inverse_z = Float8(1.0F) / z;
    const Float8 u = along(0) * colour_camera_.fx * inverse_z + colour_camera_.cx;
    const Float8 v = along(1) * colour_camera_.fy * inverse_z + colour_camera_.cy;
    const auto in_image = (Float8(kNearest_m) < z) & (Float8(0.0F) <= u) & (u < colour_camera_.width - 1.0F) &
                          (Float8(0.0F) <= v) & (v < colour_camera_.height - 1.0F);
    take &= in_image.bits();
    if (take == 0) return;
    alignas(32) std::array<float, 8> pixel_x, pixel_y, parts;
    (u + 0.5F).store(pixel_x);
    (v + 0.5F).store(pixel_y);
    part.store(parts);
    ColourBlock& colours = tree_.colours(block);
    for (; take != 0; take &= take - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(take));
      const Rgb seen = frame_.colour.at(static_cast<int>(pixel_x[i]), static_cast<int>(pixel_y[i]));
      Rgb& own = colours.colours[i];
      own = (block.coloured >> i & 1U) != 0 ? blended(own, seen, parts[i]) : seen;
      block.coloured |= static_cast<std::uint8_t>(1U << i);
    }
  }

  static Rgb blended(const Rgb& own, const Rgb& seen, float part) {
    const auto channel = [part](std::uint8_t a, std::uint8_t b) {
      return static_cast<std::uint8_t>(static_cast<float>(a) + static_cast<float>(b - a) * part + 0.5F);
    };
    return {channel(own.r, seen.r), channel(own.g, seen.g), channel(own.b, seen.b)};
  }

  OctreeWriter tree_;
  const Frame& frame_;
  const FusionConfig& config_;
  CellSize size_;
  float cell_m_;
  Pinhole camera_, colour_camera_;
  Eigen::Matrix4f T_colour_depth_;
  float truncation_m_, colour_distance_m_;
  float behind_;  // -kBehind_cells as distance, in units of BlockUnits::distance_m
  // In units of BlockUnits::log_odds.
  struct LogOddsSteps {
    float hit, miss, min, max;
  };
  LogOddsSteps log_odds_;
  bool has_colour_ = false;
};

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
  Descent(OctreeWriter tree, const Frame& frame, const Eigen::Isometry3d& T_camera_world,
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
    BlockOctree& tree = tree_.tree();
    tree.root = update(tree.root, 0, root);
    branches_ = nullptr;
    if (branches.empty()) return;
    update_branches(branches, threads);
    tree.gather_free();
    tree.root = prune_above_branches(tree.root, 0);
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
    std::vector<Descent> of_threads(threads, *this);
    for (unsigned lane = 0; lane < threads; ++lane) of_threads[lane].write_with({tree_.tree(), lane});
    parallel_for(branches.size(), threads, [&](std::size_t i, unsigned thread) {
      Slot& slot = slot_of(branches[i].code);
      slot = of_threads[thread].update(slot, kBranchDepth, branches[i]);
    });
  }

  void write_with(OctreeWriter tree) {
    tree_ = tree;
    voxels_.write_with(tree);
    coarse_cells_.write_with(tree);
  }

  // Returns the node at kBranchDepth with a Morton code. All nodes above it must be inner blocks.
  Slot& slot_of(std::uint64_t code) {
    Slot* slot = &tree_.tree().root;
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
    return ((fibonacci_hash(code) >> 60U) + frame_index_) % 16 == 0;
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

  OctreeWriter tree_;
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

void require_valid(const FusionConfig& c) {
  const ConfigCheck require{"fusion"};
  require(c.max_range_m > 0.0F && c.max_range_m <= 100.0F, "max_range_m", c.max_range_m, "in 0..100 m");
  require(c.truncation_voxels >= 1.5F && c.truncation_voxels <= 100.0F, "truncation_voxels",
          c.truncation_voxels, "in 1.5..100, or the surface falls between samples");
  require(c.truncation_sigmas >= 0.0F && c.truncation_sigmas <= 10.0F, "truncation_sigmas",
          c.truncation_sigmas, "in 0..10");
  require(c.max_cell_sigmas >= 0.0F && c.max_cell_sigmas <= 100.0F, "max_cell_sigmas", c.max_cell_sigmas,
          "in 0..100");
  require(c.max_weight > 0.0F && std::isfinite(c.max_weight), "max_weight", c.max_weight, "> 0");
  require(c.seen_through_gain > 0.0F && std::isfinite(c.seen_through_gain), "seen_through_gain",
          c.seen_through_gain, "> 0");
  require(c.hit_log_odds > 0.0F && std::isfinite(c.hit_log_odds), "hit_log_odds", c.hit_log_odds, "> 0");
  require(c.miss_log_odds < 0.0F && std::isfinite(c.miss_log_odds), "miss_log_odds", c.miss_log_odds, "< 0");
  require(c.min_log_odds < 0.0F && std::isfinite(c.min_log_odds), "min_log_odds", c.min_log_odds, "< 0");
  require(c.threads >= 0, "threads", c.threads, ">= 0");
  require(c.max_log_odds > 0.0F && std::isfinite(c.max_log_odds), "max_log_odds", c.max_log_odds, "> 0");
}

void fuse_depth(BlockOctree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                const FusionConfig& config, const FusionScratch& scratch, const FusionExecution& execution) {
  if (execution.arithmetic == Arithmetic::kFastest)
    descend<Float8>(tree, frame, T_world_camera, config, scratch, execution.threads);
  else
    descend<PortableFloat8>(tree, frame, T_world_camera, config, scratch, execution.threads);
}

}  // namespace roomradar
