// static_map_file.cpp: reads and writes the octree in OctoMap's file formats.
#include "mapping/octree/static_map_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "mapping/octree/cell_levels.hpp"
#include "mapping/octree/octomap_tree.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr const char* kFirstLine = "# Octomap OcTree file";  // OctoMap's own
constexpr std::size_t kMaxHeaderLines = 100;

// Writes a file through a stream with 17 digits, which keep the resolution exact.
template <typename Write>
void write_stream(const std::filesystem::path& path, const Write& write) {
  AtomicFile file(path);
  file.stream().precision(17);
  write(file.stream());
  file.commit();
}

// Writes the format of OctoMap's writeNodesRecurs: each node, the mask of its children, then its children.
class NodeWriter {
 public:
  NodeWriter(const BlockOctree& tree, std::ostream& stream) : tree_(tree), stream_(stream) {
    find_greatest(tree.root);
  }

  void write(Slot node) {
    if (!node.is_block()) return put(leaf(node.log_odds()), 0);
    const OctoMapNode inner = leaf(greatest_[next_++]);
    if (node.is_leaf_block()) return write_cells(inner, tree_.leaves(node));
    const InnerBlock& block = tree_.inner(node);
    unsigned children = 0;
    for (unsigned i = 0; i < 8; ++i) children |= block.slots[i].is_unknown() ? 0 : 1U << i;
    put(inner, children);
    for (const Slot child : block.slots)
      if (!child.is_unknown()) write(child);
  }

 private:
  void put(const OctoMapNode& node, unsigned children) {
    node.writeData(stream_);
    stream_.put(static_cast<char>(children));
  }
  [[nodiscard]] OctoMapNode leaf(LogOdds log_odds) const {
    OctoMapNode node;
    node.setLogOdds(static_cast<float>(log_odds) * tree_.units().log_odds);
    return node;
  }
  void write_cells(const OctoMapNode& parent, const LeafBlock& block) {
    unsigned children = 0;
    for (unsigned i = 0; i < 8; ++i) children |= block.holds(i) ? 1U << i : 0;
    put(parent, children);
    for (unsigned i = 0; i < 8; ++i) {
      if (!block.holds(i)) continue;
      OctoMapNode node = leaf(block.log_odds[i]);
      node.distance_m = static_cast<float>(block.distance[i]) * tree_.units().distance_m;
      node.weight = static_cast<float>(block.weight[i]) * tree_.units().weight;
      node.colour = tree_.colour(block, i);
      node.colour_count = block.coloured >> i & 1U;
      put(node, 0);
    }
  }
  // Appends to greatest_ the greatest log-odds below each block of the subtree, and returns the node's.
  LogOdds find_greatest(Slot node) {
    if (!node.is_block()) return node.log_odds();
    constexpr LogOdds kNone = std::numeric_limits<LogOdds>::min();
    const std::size_t at = greatest_.size();
    greatest_.push_back(kNone);
    LogOdds found = kNone;
    if (node.is_leaf_block()) {
      const LeafBlock& block = tree_.leaves(node);
      for (unsigned i = 0; i < 8; ++i)
        if (block.holds(i)) found = std::max(found, block.log_odds[i]);
    } else {
      for (const Slot child : tree_.inner(node).slots)
        if (!child.is_unknown()) found = std::max(found, find_greatest(child));
    }
    return greatest_[at] = found;
  }

  const BlockOctree& tree_;
  std::ostream& stream_;
  // OctoMap's convention: the log-odds of an inner node are the maximum of its leaves. Blocks depth first, in
  // the order in which they are written.
  std::vector<LogOdds> greatest_;
  std::size_t next_ = 0;
};

// Writes free and occupied only, in the format of OctoMap's writeBinaryNode: two bits for each child of a
// node, then the children's subtrees.
class PlainWriter {
 public:
  enum Kind : unsigned { kUnknown = 0, kFree = 1, kOccupied = 2, kMixed = 3 };

  explicit PlainWriter(const BlockOctree& tree) : tree_(tree) {
    const Kind kind = write(tree.root);
    if (kind == kUnknown) return;
    ++nodes_;
    if (kind != kMixed) {  // the format cannot express a root without children
      bytes_.assign(2, static_cast<char>(0b01010101U * kind));
      nodes_ += 8;
    }
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] std::size_t nodes() const { return nodes_; }

 private:
  static Kind kind_of(LogOdds log_odds) {
    return log_odds == 0 ? kUnknown : log_odds < 0 ? kFree : kOccupied;
  }

  // Appends a node's subtree unless it is uniform; returns the node's kind.
  Kind write(Slot node) {
    if (!node.is_block()) return kind_of(node.log_odds());
    const std::size_t start = bytes_.size();
    bytes_.append(2, '\0');
    unsigned kinds = 0;
    std::size_t children = 0;
    for (unsigned i = 0; i < 8; ++i) {
      const Kind kind =
          node.is_leaf_block() ? kind_of(tree_.leaves(node).log_odds[i]) : write(tree_.inner(node).slots[i]);
      kinds |= kind << 2 * i;
      children += kind != kUnknown ? 1 : 0;
    }
    const auto first = static_cast<Kind>(kinds & 3U);
    if (first != kMixed && kinds == 0b0101'0101'0101'0101U * first) {
      bytes_.resize(start);
      return first;
    }
    bytes_[start] = static_cast<char>(kinds & 0xFFU);
    bytes_[start + 1] = static_cast<char>(kinds >> 8U);
    nodes_ += children;
    return kMixed;
  }

  const BlockOctree& tree_;
  std::string bytes_;
  std::size_t nodes_ = 0;
};

std::string_view take_line(ByteReader& in) {
  const std::size_t end = in.rest().find('\n');
  if (end == std::string_view::npos) in.fail("is not an octree file, or its header is cut short");
  return in.take(end + 1).substr(0, end);
}

struct Header {
  std::uint64_t nodes = 0;
  double resolution_m = 0.0;
};

Header read_header(ByteReader& bytes) {
  if (!take_line(bytes).starts_with(kFirstLine))
    bytes.fail("is not an octree file: its first line is not OctoMap's");
  Header header;
  std::string type;
  for (std::size_t line_number = 0; line_number < kMaxHeaderLines; ++line_number) {
    std::istringstream words{std::string(take_line(bytes))};
    words.imbue(std::locale::classic());
    std::string name;
    words >> name;
    if (name == "data") {
      if (type != OctoMapTree::kTreeType)
        bytes.fail("holds a tree of type \"" + type.substr(0, 40) + "\"; wanted " + OctoMapTree::kTreeType);
      if (!(header.resolution_m >= 0.001 && header.resolution_m <= 1.0))
        bytes.fail("its resolution is not within 0.001..1 m");
      return header;
    }
    if (name == "id") words >> type;
    if (name == "size") words >> header.nodes;
    if (name == "res") words >> header.resolution_m;
    if (!words && !name.empty() && name[0] != '#')
      bytes.fail("its header line \"" + name.substr(0, 40) + "\" has no value");
  }
  bytes.fail("its header has no end");
}

// Reads the format of OctoMap's readNodesRecurs. Unlike OctoMap, checks depth, ends and numbers.
class NodeReader {
 public:
  NodeReader(ByteReader& bytes, BlockOctree& tree) : bytes_(bytes), tree_(tree) {}

  /// Reads the next node and its subtree. Ignores an inner node's own log-odds, which follow from its
  /// children.
  Slot read(unsigned depth) {
    const Leaf node = read_fields();
    return read_subtree(node, bytes_.number<std::uint8_t>(), depth);
  }
  [[nodiscard]] std::uint64_t nodes() const { return nodes_; }

 private:
  struct Sample {
    float distance_m, weight;
    Rgb colour;
    bool has_colour;
  };
  struct Leaf {
    LogOdds log_odds = 0;
    std::optional<Sample> sample;
  };

  Leaf read_fields() {
    ++nodes_;
    Leaf leaf;
    const auto log_odds = bytes_.number<float>();
    const auto sampled = bytes_.number<std::uint8_t>();
    if (!(std::abs(log_odds) <= 1000.0F) || sampled > 1) fault();
    leaf.log_odds = static_cast<LogOdds>(in_steps(log_odds, tree_.units().log_odds, -32767.0F, 32767.0F));
    if (leaf.log_odds == 0 && log_odds != 0.0F) leaf.log_odds = log_odds < 0.0F ? -1 : 1;
    if (sampled == 0) return leaf;
    Sample sample;
    sample.distance_m = bytes_.number<float>();
    sample.weight = bytes_.number<float>();
    sample.colour = bytes_.number<Rgb>();
    sample.has_colour = bytes_.number<std::uint8_t>() > 0;
    if (!(std::abs(sample.distance_m) <= 1000.0F && sample.weight > 0.0F && sample.weight <= 1e6F)) fault();
    leaf.sample = sample;
    return leaf;
  }

  /// @param node  the node's own fields
  /// @param children  bit i: child i follows
  Slot read_subtree(const Leaf& node, unsigned children, unsigned depth) {
    if (node.sample || depth >= kLeafDepth) fault();
    if (children == 0) {
      if (!is_plausible_cube(tree_, node.log_odds, depth)) fault();
      return Slot::cube(node.log_odds);
    }
    if (depth == kLeafDepth - 1)
      return change_leaves(tree_, Slot(), [&](LeafBlock& block) { read_voxels(children, block); });
    if (depth == kCoarseDepth) return read_coarse_or_fine(children);
    InnerBlock block;
    for (unsigned i = 0; i < 8; ++i)
      if ((children >> i & 1U) != 0) block.slots[i] = read(depth + 1);
    return tree_.prune(Slot(), block);
  }

  // Reads the children of a node at kCoarseDepth. They are coarse cells if at least one has a sample.
  Slot read_coarse_or_fine(unsigned children) {
    LeafBlock cells;
    InnerBlock block;
    for (unsigned i = 0; i < 8; ++i) {
      if ((children >> i & 1U) == 0) continue;
      const Leaf child = read_fields();
      const auto its_children = bytes_.number<std::uint8_t>();
      if (child.sample && its_children != 0) fault();
      if (child.sample)
        store(child, cells, i);
      else
        block.slots[i] = read_subtree(child, its_children, kCoarseDepth + 1);
    }
    if (!cells.has_samples()) return tree_.prune(Slot(), block);
    for (unsigned i = 0; i < 8; ++i) {
      if (block.slots[i].is_block()) fault();
      if (!block.slots[i].is_unknown()) cells.log_odds[i] = block.slots[i].log_odds();
    }
    return tree_.prune(Slot(), cells);
  }

  void read_voxels(unsigned children, LeafBlock& block) {
    for (unsigned i = 0; i < 8; ++i) {
      if ((children >> i & 1U) == 0) continue;
      const Leaf leaf = read_fields();
      if (bytes_.number<std::uint8_t>() != 0) fault();
      if (leaf.log_odds == 0 && !leaf.sample) fault();
      store(leaf, block, i);
    }
  }

  // Stores a leaf as cell i of a block.
  void store(const Leaf& leaf, LeafBlock& block, unsigned i) {
    const BlockUnits& units = tree_.units();
    block.log_odds[i] = leaf.log_odds;
    if (!leaf.sample) return;
    block.distance[i] =
        static_cast<std::int16_t>(in_steps(leaf.sample->distance_m, units.distance_m, -32767.0F, 32767.0F));
    block.weight[i] = static_cast<std::uint16_t>(in_steps(leaf.sample->weight, units.weight, 1.0F, 65535.0F));
    if (!leaf.sample->has_colour) return;
    tree_.colours(block).colours[i] = leaf.sample->colour;
    block.coloured |= static_cast<std::uint8_t>(1U << i);
  }

  static long in_steps(float value, float step, float least, float most) {
    return std::lround(std::clamp(value / step, least, most));
  }
  [[noreturn]] void fault() const {
    bytes_.fail("is damaged: node " + std::to_string(nodes_) +
                " is invalid; scan the room again or use a copy");
  }
  ByteReader& bytes_;
  OctreeWriter tree_;
  std::uint64_t nodes_ = 0;
};

}  // namespace

void write_ot_file(const BlockOctree& tree, const std::filesystem::path& path) {
  write_stream(path, [&](std::ostream& stream) {
    stream << kFirstLine << "\n#\nid " << OctoMapTree::kTreeType << "\nsize "
           << size_of(tree, tree.root, 0).nodes << "\nres " << tree.resolution_m() << "\ndata\n";
    if (!tree.root.is_unknown()) NodeWriter(tree, stream).write(tree.root);
  });
}

void write_bt_file(const BlockOctree& tree, const std::filesystem::path& path) {
  const PlainWriter plain(tree);
  write_stream(path, [&](std::ostream& stream) {
    stream << "# Octomap OcTree binary file\n#\nid OcTree\nsize " << plain.nodes() << "\nres "
           << tree.resolution_m() << "\ndata\n"
           << plain.bytes();
  });
}

void read_ot_file(const std::filesystem::path& path, const MakeOctree& make_tree) {
  const std::string file = read_bytes(path, "an octree file");
  ByteReader bytes(file, path.string());
  const Header header = read_header(bytes);
  BlockOctree& tree = make_tree(header.resolution_m);
  if (header.nodes > 0) {
    NodeReader nodes(bytes, tree);
    tree.root = nodes.read(0);
    if (nodes.nodes() != header.nodes)
      bytes.fail("holds " + std::to_string(nodes.nodes()) + " nodes, but its header says " +
                 std::to_string(header.nodes));
  }
  bytes.require_end();
}

}  // namespace roomradar
