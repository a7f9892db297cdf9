// octomap_tree.cpp: serialization of nodes, and registration of the tree type with OctoMap.
#include "mapping/octree/octomap_tree.hpp"

#include <istream>
#include <ostream>

namespace roomradar {
namespace {

template <typename Value>
void write_field(std::ostream& stream, const Value& value) {
  stream.write(reinterpret_cast<const char*>(&value), sizeof(value));
}

template <typename Value>
void get(std::istream& stream, Value& value) {
  stream.read(reinterpret_cast<char*>(&value), sizeof(value));
}

// Registers the tree type with OctoMap's factory, so octomap::AbstractOcTree::read() opens roomradar's .ot
// files.
class TreeType : public OctoMapTree {
 public:
  static bool register_it() {
    auto* tree = new OctoMapTree(0.1);  // owned by the factory until the process ends
    registerTreeType(tree);
    return true;
  }
};
const bool kRegistered = TreeType::register_it();

}  // namespace

void OctoMapNode::copyData(const OctoMapNode& from) {
  OcTreeNode::copyData(from);
  distance_m = from.distance_m;
  weight = from.weight;
  colour = from.colour;
  colour_count = from.colour_count;
}

bool OctoMapNode::operator==(const OctoMapNode& other) const {
  return value == other.value && distance_m == other.distance_m && weight == other.weight &&
         colour == other.colour && colour_count == other.colour_count;
}

std::ostream& OctoMapNode::writeData(std::ostream& stream) const {
  write_field(stream, value);
  write_field(stream, static_cast<std::uint8_t>(has_sample() ? 1 : 0));
  if (has_sample()) {
    write_field(stream, distance_m);
    write_field(stream, weight);
    write_field(stream, colour);
    write_field(stream, colour_count);
  }
  return stream;
}

std::istream& OctoMapNode::readData(std::istream& stream) {
  distance_m = weight = 0.0F;
  colour = Rgb{};
  colour_count = 0;
  std::uint8_t sampled = 0;
  get(stream, value);
  get(stream, sampled);
  if (stream && sampled == 1) {
    get(stream, distance_m);
    get(stream, weight);
    get(stream, colour);
    get(stream, colour_count);
  }
  if (sampled > 1) stream.setstate(std::ios::failbit);
  return stream;
}

OctoMapTree::OctoMapTree(double resolution_m) : OccupancyOcTreeBase<OctoMapNode>(resolution_m) {
  static_cast<void>(kRegistered);
  clearKeyRays();  // frees OctoMap's ray casting buffers, 0.6 MB per thread, unused here
}

bool OctoMapTree::isNodeCollapsible(const OctoMapNode* node) const {
  for (unsigned i = 0; i < 8; ++i) {
    if (!nodeChildExists(node, i)) return false;
    const OctoMapNode* child = getNodeChild(node, i);
    if (child->has_sample() || nodeHasChildren(child) ||
        child->getLogOdds() != getNodeChild(node, 0)->getLogOdds())
      return false;
  }
  return true;
}

}  // namespace roomradar
