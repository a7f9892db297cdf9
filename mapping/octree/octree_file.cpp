// octree_file.cpp: the tree's blocks as columns of equal fields, each compressed on its own.
//
// All numbers are little-endian. Body: resolution (f64, m), steps of log-odds, signed distance (m) and weight
// (3 f32), then columns (see compressed_columns.hpp), in the tree's depth-first order:
// - kinds of the children of each inner block (u16): bits 2 i and 2 i + 1 are the kind of child i: 0 unknown,
//   1 cube, 2 inner block, 3 leaf block. The first item is the root's kind alone.
// - log-odds of each cube (i16)
// - log-odds of the eight cells of each leaf block (i16)
// - per leaf block, bit i: cell i has a signed distance (u8); then the same for colours (u8)
// - signed distance (i16) and weight (u16) of each cell that has them: differences from their prediction
// - red, green, blue (u8) of each cell with a colour: differences of green, red - green, blue - green
// A number is predicted by the mean of the block's neighbouring cells before it, or by the last block's first
// cell. Differences wrap; of signed ones the lowest bit is the sign.
#include "mapping/octree/octree_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "mapping/storage/compressed_columns.hpp"

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
    std::string out;
    put(out, tree_.resolution_m());
    for (const float step : {tree_.units().log_odds, tree_.units().distance_m, tree_.units().weight})
      put(out, step);
    const auto move_column = [&](auto& column) { put_column(out, std::exchange(column, {})); };
    move_column(kinds_);
    move_column(cubes_);
    move_column(log_odds_);
    move_column(sampled_);
    move_column(coloured_);
    move_column(distances_);
    move_column(weights_);
    for (std::vector<std::uint8_t>* channel : {&red_, &green_, &blue_}) move_column(*channel);
    return out;
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
    tree_.root = take_node(take(kinds_), 0);
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
  BlockOctree& tree_;
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

float take_step(BinaryReader& in) {
  const auto step = in.take<float>("steps");
  if (!(step > 1e-12F && step < 1e3F)) in.fail("damaged: a step of its numbers is out of range");
  return step;
}

}  // namespace

void write_octree_file(const BlockOctree& tree, const std::filesystem::path& path) {
  write_binary(path, kOctreeMagic, kOctreeVersion, BlockWriter(tree).take_body());
}

void read_octree_file(const std::filesystem::path& path, const MakeOctree& make_tree) {
  const std::string body = read_binary(path, kOctreeMagic, kOctreeVersion);
  ColumnReader in(body, path);
  const double resolution_m = in.numbers().take_finite("resolution");
  if (!(resolution_m >= 0.001 && resolution_m <= 1.0))
    in.numbers().fail("damaged: its resolution is not within 0.001..1 m");
  BlockUnits units;
  units.log_odds = take_step(in.numbers());
  units.distance_m = take_step(in.numbers());
  units.weight = take_step(in.numbers());
  BlockReader(in, units, make_tree(resolution_m)).read();
}

}  // namespace roomradar
