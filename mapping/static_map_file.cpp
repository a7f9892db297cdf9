// static_map_file.cpp: the octree to and from OctoMap's file forms.
#include <octomap/OcTree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "mapping/static_map.hpp"
#include "mapping/static_map_octree.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

constexpr const char* kFirstLine = "# Octomap OcTree file";  // OctoMap's own
constexpr std::size_t kMaxHeaderLines = 100;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

// OctoMap prints the resolution with the stream's precision, and reports failed writes only through the
// stream.
template <typename Write>
void write_stream(const std::filesystem::path& path, const Write& write) {
  std::ofstream file(path, std::ios::binary);
  if (!file) fail(path, "cannot be created; does its folder exist, and may you write there?");
  file.precision(17);
  write(file);
  file.flush();
  if (!file) fail(path, "cannot be written; is the disk full?");
}

// Whether any leaf below (or the node itself, if it is one) is occupied or free.
bool is_known(const RoomOcTree& tree, const RoomNode& node) {
  if (!tree.nodeHasChildren(&node)) return node.getLogOdds() != 0.0F;
  for (unsigned i = 0; i < 8; ++i)
    if (const RoomNode* child = tree.child(node, i); child && is_known(tree, *child)) return true;
  return false;
}

// Copies what is known below `from` to `to`, which has no children yet.
void copy_known(const RoomOcTree& from_tree, const RoomNode& from, octomap::OcTree& to_tree,
                octomap::OcTreeNode& to) {
  if (!from_tree.nodeHasChildren(&from)) {
    to.setLogOdds(from.getLogOdds() > 0.0F ? to_tree.getClampingThresMaxLog()
                                           : to_tree.getClampingThresMinLog());
    return;
  }
  for (unsigned i = 0; i < 8; ++i) {
    const RoomNode* child = from_tree.child(from, i);
    if (child && is_known(from_tree, *child))
      copy_known(from_tree, *child, to_tree, *to_tree.createNodeChild(&to, i));
  }
  if (!to_tree.pruneNode(&to)) to.updateOccupancyChildren();
}

// octomap::OcTree with a root to start copying at, which OctoMap makes only when a voxel is set.
class PlainTree : public octomap::OcTree {
 public:
  explicit PlainTree(const RoomOcTree& from) : octomap::OcTree(from.getResolution()) {
    if (!from.getRoot() || !is_known(from, *from.getRoot())) return;
    root = new octomap::OcTreeNode();
    tree_size = 1;
    copy_known(from, *from.getRoot(), *this, *root);
    size_changed = true;
  }
};

// Numbers one after the other from bytes that may end anywhere.
class ByteReader {
 public:
  ByteReader(const std::filesystem::path& path, std::vector<char> bytes)
      : path_(path), bytes_(std::move(bytes)) {}

  template <typename Value>
  Value get() {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (bytes_.size() - at_ < sizeof(Value))
      fail(path_, "is cut short after " + std::to_string(at_) + " bytes");
    Value value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(Value));
    at_ += sizeof(Value);
    return value;
  }
  std::string get_line() {
    const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(at_);
    const auto end = std::find(begin, bytes_.end(), '\n');
    if (end == bytes_.end()) fail(path_, "is not an octree file, or its header is cut short");
    at_ += static_cast<std::size_t>(end - begin) + 1;
    return {begin, end};
  }
  [[nodiscard]] std::size_t bytes_left() const { return bytes_.size() - at_; }

 private:
  const std::filesystem::path& path_;
  std::vector<char> bytes_;
  std::size_t at_ = 0;
};

std::vector<char> read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file || std::filesystem::is_directory(path)) fail(path, "cannot be opened");
  const std::streamoff size = file.tellg();
  if (size < 0) fail(path, "cannot be read");
  std::vector<char> bytes(static_cast<std::size_t>(size));
  file.seekg(0);
  file.read(bytes.data(), size);
  if (!file) fail(path, "cannot be read");
  return bytes;
}

struct Header {
  std::uint64_t nodes = 0;
  double resolution_m = 0.0;
};

Header read_header(const std::filesystem::path& path, ByteReader& bytes) {
  if (bytes.get_line().rfind(kFirstLine, 0) != 0)
    fail(path, "is not an octree file: its first line is not OctoMap's");
  Header header;
  std::string type;
  for (std::size_t line_number = 0; line_number < kMaxHeaderLines; ++line_number) {
    std::istringstream words(bytes.get_line());
    std::string name;
    words >> name;
    if (name == "data") {
      if (type != RoomOcTree::kTreeType)
        fail(path, "holds a tree of type \"" + type.substr(0, 40) + "\"; wanted " + RoomOcTree::kTreeType);
      if (!(header.resolution_m >= 0.001 && header.resolution_m <= 1.0))
        fail(path, "its resolution is not within 0.001..1 m");
      return header;
    }
    if (name == "id") words >> type;
    if (name == "size") words >> header.nodes;
    if (name == "res") words >> header.resolution_m;
    if (!words && !name.empty() && name[0] != '#')
      fail(path, "its header line \"" + name.substr(0, 40) + "\" has no value");
  }
  fail(path, "its header has no end");
}

// The form of OctoMap's readNodesRecurs, which trusts its input: here depth, ends and numbers are checked.
class NodeReader {
 public:
  NodeReader(const std::filesystem::path& path, ByteReader& bytes, RoomOcTree& tree)
      : path_(path), bytes_(bytes), tree_(tree) {}

  void read(RoomNode& node, unsigned depth) {
    ++nodes_;
    const auto log_odds = bytes_.get<float>();
    const auto sampled = bytes_.get<std::uint8_t>();
    if (!(std::abs(log_odds) <= 1000.0F) || sampled > 1) fault();
    node.setLogOdds(log_odds);
    if (sampled == 1) {
      node.distance_m = bytes_.get<float>();
      node.weight = bytes_.get<float>();
      node.colour = bytes_.get<Rgb>();
      node.colour_count = bytes_.get<std::uint8_t>();
      const bool sound = std::abs(node.distance_m) <= 1000.0F && node.weight > 0.0F && node.weight <= 1e6F;
      if (!sound || depth != kLeafDepth) fault();
    }
    const auto children = bytes_.get<std::uint8_t>();
    if (children != 0 && depth == kLeafDepth) fault();
    if (children == 0 && log_odds == 0.0F && sampled == 0) fault();
    for (unsigned i = 0; i < 8; ++i)
      if ((children >> i & 1U) != 0) read(*tree_.createNodeChild(&node, i), depth + 1);
  }
  [[nodiscard]] std::uint64_t nodes() const { return nodes_; }

 private:
  [[noreturn]] void fault() const {
    fail(path_,
         "is damaged: node " + std::to_string(nodes_) + " cannot be one; scan the room again or take a copy");
  }
  const std::filesystem::path& path_;
  ByteReader& bytes_;
  RoomOcTree& tree_;
  std::uint64_t nodes_ = 0;
};

}  // namespace

void StaticMap::write_ot(const std::filesystem::path& path) const {
  write_stream(path, [&](std::ostream& stream) { octree_->tree.write(stream); });
}

void StaticMap::write_bt(const std::filesystem::path& path) const {
  PlainTree plain(octree_->tree);
  // OctoMap's own writeBinaryConst puts a word on stderr.
  write_stream(path, [&](std::ostream& stream) {
    stream << "# Octomap OcTree binary file\n#\nid OcTree\nsize " << plain.size() << "\nres "
           << plain.getResolution() << "\ndata\n";
    if (plain.size() > 0) plain.writeBinaryData(stream);
  });
}

StaticMap StaticMap::read_ot(const std::filesystem::path& path, const FusionConfig& config) {
  ByteReader bytes(path, read_bytes(path));
  const Header header = read_header(path, bytes);
  auto octree = std::make_unique<Octree>(header.resolution_m, config);
  if (header.nodes > 0) {
    NodeReader nodes(path, bytes, octree->tree);
    nodes.read(octree->tree.ensure_root(), 0);
    if (nodes.nodes() != header.nodes)
      fail(path, "holds " + std::to_string(nodes.nodes()) + " nodes, but its header says " +
                     std::to_string(header.nodes));
  }
  if (bytes.bytes_left() != 0)
    fail(path, "has " + std::to_string(bytes.bytes_left()) + " bytes after its end");
  return StaticMap(std::move(octree));
}

}  // namespace roomradar
