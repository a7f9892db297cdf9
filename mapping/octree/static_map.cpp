// static_map.cpp: fusion into the octree, and queries on it.
#include "mapping/octree/static_map.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/cell_levels.hpp"
#include "mapping/octree/fusion.hpp"
#include "mapping/octree/fusion_config.hpp"
#include "mapping/octree/prepared_frame.hpp"
#include "mapping/octree/static_map_file.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kOctreeMagic = "RROCTREE";
constexpr std::uint32_t kOctreeVersion = 1;

enum NodeKind : unsigned { kUnknownNode, kCubeNode, kInnerNode, kLeavesNode };

NodeKind kind_of(Slot slot) {
  if (slot.is_unknown()) return kUnknownNode;
  if (slot.is_cube()) return kCubeNode;
  return slot.is_inner_block() ? kInnerNode : kLeavesNode;
}

/// Predicts a field of a leaf block's cells from the cells before it, in order of their index.
class Predictor {
 public:
  void begin_block() { cells_ = 0; }
  [[nodiscard]] int prediction(unsigned i) const {
    int sum = 0, count = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned neighbour = i ^ 1U << axis;
      if ((i >> axis & 1U) == 0 || (cells_ >> neighbour & 1U) == 0) continue;
      sum += values_[neighbour];
      ++count;
    }
    return count > 0 ? sum / count : first_;
  }
  void add(unsigned i, int value) {
    if (cells_ == 0) first_ = value;
    cells_ |= 1U << i;
    values_[i] = value;
  }

 private:
  std::array<int, 8> values_{};
  unsigned cells_ = 0;
  int first_ = 0;  ///< of the last block that has the field
};

struct Predictors {
  Predictor distance, weight, green, red, blue;

  void begin_block() {
    for (Predictor* predictor : {&distance, &weight, &green, &red, &blue}) predictor->begin_block();
  }
};

class BlockWriter {
 public:
  explicit BlockWriter(const BlockOctree& tree) : tree_(tree) {
    kinds_.push_back(static_cast<std::uint16_t>(kind_of(tree.root)));
    put_node(tree.root);
  }

  /// Returns the file's body. Uses up the columns.
  [[nodiscard]] std::string take_body() {
    ByteWriter out;
    out(tree_.resolution_m(), tree_.units().log_odds, tree_.units().distance_m, tree_.units().weight);
    const auto move_column = [&](auto& column) { put_column(out.bytes, std::exchange(column, {})); };
    move_column(kinds_);
    move_column(cubes_);
    move_column(log_odds_);
    move_column(sampled_);
    move_column(coloured_);
    move_column(distances_);
    move_column(weights_);
    for (std::vector<std::uint8_t>* channel : {&red_, &green_, &blue_}) move_column(*channel);
    return std::move(out.bytes);
  }

 private:
  void put_node(Slot node) {
    if (node.is_cube()) cubes_.push_back(node.log_odds());
    if (node.is_leaf_block()) put_cells(tree_.leaves(node));
    if (!node.is_inner_block()) return;
    const InnerBlock& block = tree_.inner(node);
    unsigned kinds = 0;
    for (unsigned i = 0; i < 8; ++i) kinds |= kind_of(block.slots[i]) << 2U * i;
    kinds_.push_back(static_cast<std::uint16_t>(kinds));
    for (const Slot child : block.slots) put_node(child);
  }

  void put_cells(const LeafBlock& block) {
    log_odds_.insert(log_odds_.end(), block.log_odds.begin(), block.log_odds.end());
    predict_.begin_block();
    unsigned sampled = 0;
    for (unsigned i = 0; i < 8; ++i) {
      if (block.weight[i] == 0) continue;
      sampled |= 1U << i;
      put_difference(block.distance[i], predict_.distance, i, distances_);
      put_difference(block.weight[i], predict_.weight, i, weights_);
      if ((block.coloured >> i & 1U) != 0) put_colour(tree_.colour(block, i), i);
    }
    sampled_.push_back(static_cast<std::uint8_t>(sampled));
    coloured_.push_back(static_cast<std::uint8_t>(sampled & block.coloured));
  }

  static void put_difference(int value, Predictor& predictor, unsigned i, std::vector<std::uint16_t>& out) {
    out.push_back(with_sign_last(static_cast<std::uint16_t>(value - predictor.prediction(i))));
    predictor.add(i, value);
  }

  void put_colour(Rgb colour, unsigned i) {
    const int green = colour.g - predict_.green.prediction(i);
    green_.push_back(static_cast<std::uint8_t>(green));
    red_.push_back(static_cast<std::uint8_t>(colour.r - predict_.red.prediction(i) - green));
    blue_.push_back(static_cast<std::uint8_t>(colour.b - predict_.blue.prediction(i) - green));
    predict_.green.add(i, colour.g);
    predict_.red.add(i, colour.r);
    predict_.blue.add(i, colour.b);
  }

  const BlockOctree& tree_;
  Predictors predict_;
  std::vector<std::uint16_t> kinds_, distances_, weights_;
  std::vector<std::int16_t> cubes_, log_odds_;
  std::vector<std::uint8_t> sampled_, coloured_, red_, green_, blue_;
};

/// A column that is read item by item.
template <typename Number>
struct Column {
  std::vector<Number> items;
  std::size_t next = 0;
};

class BlockReader {
 public:
  BlockReader(ColumnReader& in, const BlockUnits& file, BlockOctree& tree)
      : in_(in),
        tree_(tree),
        ratios_{file.log_odds / tree.units().log_odds, file.distance_m / tree.units().distance_m,
                file.weight / tree.units().weight} {
    kinds_.items = in.take<std::uint16_t>("kinds of nodes");
    cubes_.items = in.take<std::int16_t>("log-odds of cubes");
    log_odds_.items = in.take<std::int16_t>("log-odds of cells");
    const std::size_t blocks = log_odds_.items.size() / 8;
    sampled_.items = in.take<std::uint8_t>("masks of samples", blocks);
    coloured_.items = in.take<std::uint8_t>("masks of colours", blocks);
    distances_.items = in.take<std::uint16_t>("signed distances");
    weights_.items = in.take<std::uint16_t>("weights", distances_.items.size());
    red_.items = in.take<std::uint8_t>("red levels");
    green_.items = in.take<std::uint8_t>("green levels", red_.items.size());
    blue_.items = in.take<std::uint8_t>("blue levels", red_.items.size());
    if (in.numbers().left() != 0)
      in.numbers().fail(std::to_string(in.numbers().left()) + " bytes more than the octree takes");
  }

  void read() {
    tree_.tree().root = take_node(take(kinds_), 0);
    require_used(kinds_);
    require_used(cubes_);
    require_used(log_odds_);
    require_used(distances_);
    require_used(red_);
  }

 private:
  [[noreturn]] void fault() const {
    in_.numbers().fail("damaged: node " + std::to_string(nodes_) + " is invalid");
  }
  template <typename Number>
  Number take(Column<Number>& column) const {
    if (column.next == column.items.size()) fault();
    return column.items[column.next++];
  }
  template <typename Number>
  void require_used(const Column<Number>& column) const {
    if (column.next != column.items.size()) fault();
  }

  Slot take_node(unsigned kind, unsigned depth) {
    ++nodes_;
    switch (kind) {
      case kUnknownNode:
        return {};
      case kCubeNode: {
        const LogOdds log_odds = rescaled_log_odds(take(cubes_));
        if (!is_plausible_cube(tree_, log_odds, depth)) fault();
        return Slot::cube(log_odds);
      }
      case kInnerNode:
        return take_inner(depth);
      case kLeavesNode:
        return take_cells(depth);
      default:
        fault();
    }
  }

  Slot take_inner(unsigned depth) {
    if (depth >= kLeafDepth - 1) fault();
    const unsigned kinds = take(kinds_);
    InnerBlock block;
    for (unsigned i = 0; i < 8; ++i) block.slots[i] = take_node(kinds >> 2U * i & 3U, depth + 1);
    return tree_.prune(Slot(), block);
  }

  Slot take_cells(unsigned depth) {
    LeafBlock block;
    for (LogOdds& log_odds : block.log_odds) log_odds = rescaled_log_odds(take(log_odds_));
    const unsigned sampled = take(sampled_), coloured = take(coloured_);
    if ((depth != kLeafDepth - 1 && depth != kCoarseDepth) || (depth == kCoarseDepth && sampled == 0) ||
        (coloured & ~sampled) != 0)
      fault();
    predict_.begin_block();
    for (unsigned i = 0; i < 8; ++i) {
      if ((sampled >> i & 1U) == 0) continue;
      const auto distance = static_cast<std::int16_t>(take_value(distances_, predict_.distance, i));
      const auto weight = static_cast<std::uint16_t>(take_value(weights_, predict_.weight, i));
      predict_.distance.add(i, distance);
      predict_.weight.add(i, weight);
      if (weight == 0) fault();
      block.distance[i] =
          static_cast<std::int16_t>(rescaled(distance, ratios_.distance, -32767.0F, 32767.0F));
      block.weight[i] = static_cast<std::uint16_t>(rescaled(weight, ratios_.weight, 1.0F, 65535.0F));
      if ((coloured >> i & 1U) != 0) tree_.colours(block).colours[i] = take_colour(i);
    }
    block.coloured = static_cast<std::uint8_t>(coloured);
    return tree_.prune(Slot(), block);
  }

  int take_value(Column<std::uint16_t>& column, const Predictor& predictor, unsigned i) const {
    return predictor.prediction(i) + static_cast<std::int16_t>(from_sign_last(take(column)));
  }

  Rgb take_colour(unsigned i) {
    const unsigned green = take(green_);
    const auto level = [&](unsigned difference, Predictor& predictor) {
      const auto value =
          static_cast<std::uint8_t>(static_cast<unsigned>(predictor.prediction(i)) + difference);
      predictor.add(i, value);
      return value;
    };
    return {.r = level(take(red_) + green, predict_.red),
            .g = level(green, predict_.green),
            .b = level(take(blue_) + green, predict_.blue)};
  }

  // The steps of a file differ from the tree's if it was written with other settings of fusion.
  static int rescaled(int value, float ratio, float least, float most) {
    if (ratio == 1.0F) return value;
    return static_cast<int>(std::lround(std::clamp(static_cast<float>(value) * ratio, least, most)));
  }
  [[nodiscard]] LogOdds rescaled_log_odds(int value) const {
    const int log_odds = rescaled(value, ratios_.log_odds, -32767.0F, 32767.0F);
    if (log_odds == 0 && value != 0) return value < 0 ? -1 : 1;
    return static_cast<LogOdds>(log_odds);
  }

  ColumnReader& in_;
  OctreeWriter tree_;
  /// Steps of the file's integers, divided by those of the tree.
  struct StepRatios {
    float log_odds, distance, weight;
  };
  StepRatios ratios_;
  Column<std::uint16_t> kinds_, distances_, weights_;
  Column<std::int16_t> cubes_, log_odds_;
  Column<std::uint8_t> sampled_, coloured_, red_, green_, blue_;
  Predictors predict_;
  std::uint64_t nodes_ = 0;
};

/// Writes the tree's blocks; see StaticMap::write().
void write_octree_file(const BlockOctree& tree, const std::filesystem::path& path) {
  write_binary(path, kOctreeMagic, kOctreeVersion, BlockWriter(tree).take_body());
}

/// Reads a file written by write_octree_file(); see StaticMap::read(). Calls `make_tree` once the resolution
/// is known, and fills the tree that it returns.
void read_octree_file(const std::filesystem::path& path, const MakeOctree& make_tree) {
  const std::string body = read_binary(path, kOctreeMagic, kOctreeVersion);
  ColumnReader in(body, path.string());
  double resolution_m = 0.0;
  BlockUnits units;
  in.numbers()(resolution_m, units.log_odds, units.distance_m, units.weight);
  if (!(resolution_m >= 0.001 && resolution_m <= 1.0))
    in.numbers().fail("damaged: its resolution is not within 0.001..1 m");
  for (const float step : {units.log_odds, units.distance_m, units.weight})
    if (!(step > 1e-12F && step < 1e3F)) in.numbers().fail("damaged: a step of its numbers is out of range");
  BlockReader(in, units, make_tree(resolution_m)).read();
}

void add_evidence(BlockOctree& tree, const FusionConfig& config, const BlockOctree& other,
                  const KeyRange& range = {});

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
Slot revise_coarse(OctreeWriter tree, Slot node, const NodePlace& place, LogOdds free, const KeyRange& range,
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
Slot revise(OctreeWriter tree, Slot node, const NodePlace& place, LogOdds free, const KeyRange& range,
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
  AddLogOdds(OctreeWriter tree, const FusionConfig& config, float log_odds)
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
  OctreeWriter tree_;
  const FusionConfig& config_;
  float added_;
};

// Averages a sample of another map into voxel i.
void add_sample(OctreeWriter tree, LeafBlock& block, unsigned i, const SurfaceSample& sample) {
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
  AddMap(OctreeWriter tree, const FusionConfig& config, const BlockOctree& other, const KeyRange& range)
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

  OctreeWriter tree_;
  const FusionConfig& config_;
  const BlockOctree& other_;
  KeyRange range_;
};

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

/// Refines a coarse cell if `decide` returns an action other than kKeep for one of its voxels.
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

/// Adds evidence of another map: the log-odds of a leaf, a sample (as a weighted mean), or all in a range of
/// keys.
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

const FusionConfig& checked(const FusionConfig& config) {
  require_valid(config);
  return config;
}

double checked_resolution(double resolution_m) {
  if (!(resolution_m >= 0.001 && resolution_m <= 1.0))
    throw Error("resolution = " + format_number(resolution_m) + " m: must be between 0.001 and 1 m");
  return resolution_m;
}

/// Returns the number of threads to fuse a frame with. Small images are not worth several.
unsigned threads_for(const DepthImage& depth_m, const FusionConfig& config) {
  constexpr std::size_t kWorthAThread_px = 25'000;
  const std::size_t most = config.threads > 0 ? static_cast<std::size_t>(config.threads) : hardware_threads();
  return static_cast<unsigned>(
      std::clamp<std::size_t>(std::min(most, depth_m.pixels.size() / kWorthAThread_px), 1, kMaxLanes));
}

}  // namespace

struct StaticMap::Octree {
  Octree(double resolution_m, const FusionConfig& fusion);
  FusionConfig config;
  BlockOctree tree;
  PreparedFrame prepared;  ///< reused by fuse() of a frame that is not prepared
};

StaticMap::Octree::Octree(double resolution_m, const FusionConfig& fusion)
    : config(checked(fusion)), tree(checked_resolution(resolution_m), config) {}

StaticMap::StaticMap(double resolution_m, const FusionConfig& config)
    : octree_(std::make_unique<Octree>(resolution_m, config)) {}
StaticMap::StaticMap(std::unique_ptr<Octree> octree) : octree_(std::move(octree)) {}
StaticMap::~StaticMap() = default;
StaticMap::StaticMap(StaticMap&&) noexcept = default;
StaticMap& StaticMap::operator=(StaticMap&&) noexcept = default;

FuseStatus StaticMap::fuse(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  prepare_frame(frame, T_world_camera, resolution_m(), config(), threads_for(frame.depth_m, config()),
                octree_->prepared);
  return fuse(frame, octree_->prepared);
}

void StaticMap::prepare(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                        PreparedFrame& prepared) const {
  prepare_frame(frame, T_world_camera, resolution_m(), config(), /*threads=*/1, prepared);
}

FuseStatus StaticMap::fuse(const Frame& frame, const PreparedFrame& prepared) {
  if (prepared.status == FuseStatus::kFused)
    fuse_depth(octree_->tree, frame, prepared.T_world_camera, prepared.config, prepared.scratch,
               {.threads = threads_for(frame.depth_m, config())});
  return prepared.status;
}

Occupancy StaticMap::occupancy_at(const Eigen::Vector3d& p_world) const {
  return roomradar::occupancy_at(octree_->tree, p_world);
}
std::optional<SurfaceSample> StaticMap::sample_at(const Eigen::Vector3d& p_world) const {
  return roomradar::sample_at(octree_->tree, p_world);
}
void StaticMap::visit_samples(const std::function<void(const SurfaceSample&)>& visit) const {
  roomradar::visit_samples(octree_->tree, {}, visit);
}
void StaticMap::visit_samples(const Eigen::AlignedBox3d& box_world,
                              const std::function<void(const SurfaceSample&)>& visit) const {
  roomradar::visit_samples(octree_->tree, keys_in(box_world, resolution_m()), visit);
}

void StaticMap::visit_cells(const Eigen::AlignedBox3d& box_world,
                            const std::function<void(const SurfaceSample&, int)>& visit) const {
  roomradar::visit_cells(octree_->tree, keys_in(box_world, resolution_m()), visit);
}

void StaticMap::visit_leaves(const std::function<void(const MapLeaf&)>& visit) const {
  const BlockOctree& tree = octree_->tree;
  for_each_leaf(tree, [&](const NodePlace& place, LogOdds log_odds) {
    visit({(place.key - kKeyOrigin).matrix(), place.edge_voxels(), log_odds * tree.units().log_odds});
  });
}

void StaticMap::add_evidence(const MapLeaf& leaf) {
  roomradar::add_evidence(octree_->tree, octree_->config, leaf);
}
void StaticMap::add_evidence(const SurfaceSample& sample) { roomradar::add_evidence(octree_->tree, sample); }

void StaticMap::add_evidence(const StaticMap& other) {
  roomradar::add_evidence(octree_->tree, octree_->config, other.octree_->tree);
}

void StaticMap::add_evidence(const StaticMap& other, const VoxelIndex& lowest_voxel, int edge_voxels) {
  const Eigen::Array3i first = lowest_voxel.array() + kKeyOrigin;
  roomradar::add_evidence(octree_->tree, octree_->config, other.octree_->tree,
                          {first, first + (edge_voxels - 1)});
}

void StaticMap::revise_samples(const std::function<SampleAction(const SurfaceSample&)>& decide) {
  roomradar::revise_samples(octree_->tree, octree_->config, {}, decide);
}
void StaticMap::revise_samples(const Eigen::AlignedBox3d& box_world,
                               const std::function<SampleAction(const SurfaceSample&)>& decide) {
  roomradar::revise_samples(octree_->tree, octree_->config, keys_in(box_world, resolution_m()), decide);
}

double StaticMap::resolution_m() const { return octree_->tree.resolution_m(); }
double StaticMap::reach_m() const { return resolution_m() * kKeyOrigin; }
const FusionConfig& StaticMap::config() const { return octree_->config; }
std::size_t StaticMap::memory_bytes() const { return octree_->tree.memory_bytes(); }

MapCounts StaticMap::counts() const {
  MapCounts counts;
  const BlockOctree& tree = octree_->tree;
  for_each_leaf(tree, [&](const NodePlace& place, LogOdds log_odds) {
    const Eigen::Vector3d low = (place.key - kKeyOrigin).cast<double>().matrix() * tree.resolution_m();
    const Eigen::Vector3d edges = Eigen::Vector3d::Constant(place.edge_voxels() * tree.resolution_m());
    const Eigen::AlignedBox3d box(low, low + edges);
    counts.known_world.extend(box);
    if (log_odds < 0) {
      ++counts.free_leaves;
    } else {
      ++counts.occupied_leaves;
      counts.occupied_world.extend(box);
    }
  });
  visit_samples([&](const SurfaceSample&) { ++counts.sampled_leaves; });
  const SubtreeSize size = size_of(tree, tree.root, 0);
  counts.nodes = size.nodes;
  counts.memory_bytes = size.bytes;
  return counts;
}

void StaticMap::write(const std::filesystem::path& path) const { write_octree_file(octree_->tree, path); }
void StaticMap::write_ot(const std::filesystem::path& path) const { write_ot_file(octree_->tree, path); }
void StaticMap::write_bt(const std::filesystem::path& path) const { write_bt_file(octree_->tree, path); }

template <typename ReadFile>
StaticMap StaticMap::read_by(const ReadFile& read_file, const FusionConfig& config) {
  std::unique_ptr<Octree> octree;
  read_file([&](double resolution_m) -> BlockOctree& {
    octree = std::make_unique<Octree>(resolution_m, config);
    return octree->tree;
  });
  return StaticMap(std::move(octree));
}

StaticMap StaticMap::read(const std::filesystem::path& path, const FusionConfig& config) {
  return read_by([&](const MakeOctree& make_tree) { read_octree_file(path, make_tree); }, config);
}
StaticMap StaticMap::read_ot(const std::filesystem::path& path, const FusionConfig& config) {
  return read_by([&](const MakeOctree& make_tree) { read_ot_file(path, make_tree); }, config);
}

std::string_view to_string(FuseStatus status) {
  switch (status) {
    case FuseStatus::kFused:
      return "fused";
    case FuseStatus::kNothingMeasured:
      return "nothing measured";
    case FuseStatus::kInvalidFrame:
      return "invalid frame";
    case FuseStatus::kInvalidPose:
      return "invalid pose";
    case FuseStatus::kOutOfBounds:
      return "out of the octree's reach";
  }
  return "unknown status";
}

}  // namespace roomradar
