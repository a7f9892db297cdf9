// room_octree.hpp: OctoMap's octree with a node that also knows how far the surface is.
// Private to the static map: besides static_map* and fusion* nobody includes it, or OctoMap.
#pragma once
#include <octomap/OcTreeNode.h>
#include <octomap/OccupancyOcTreeBase.h>

#include <cstdint>
#include <iosfwd>
#include <string>

#include "mapping/types/image.hpp"

namespace roomradar {

inline constexpr unsigned kLeafDepth = 16;  // OctoMap's, from its 16-bit keys
inline constexpr int kKeyOrigin = 32768;    // key of the voxel whose lower corner is the world's origin

/// Log-odds of exactly 0 is a probability of one half: nothing known. Leaves hidden behind a surface have
/// that and a signed distance; what has neither is not stored. Only finest leaves have a signed distance
/// (weight > 0). The fields fill OctoMap's padding: 24 bytes, what glibc's smallest block holds.
class RoomNode : public octomap::OcTreeNode {
 public:
  float distance_m = 0.0F;
  float weight = 0.0F;
  Rgb colour;
  std::uint8_t colour_count = 0;

  [[nodiscard]] bool has_sample() const { return weight > 0.0F; }
  void forget_sample() {
    distance_m = weight = 0.0F;
    colour = Rgb{};
    colour_count = 0;
  }
  /// OctoMap keeps the table of a node whose children were all deleted, and then will not let the node go.
  void free_empty_child_table() {
    delete[] children;
    children = nullptr;
  }
  void copyData(const RoomNode& from);
  bool operator==(const RoomNode& other) const;

  /// Called by OctoMap when it writes and reads .ot: log-odds, then a byte that says whether a sample
  /// follows.
  std::ostream& writeData(std::ostream& stream) const;
  std::istream& readData(std::istream& stream);
};
static_assert(sizeof(RoomNode) == 24);

class RoomOcTree : public octomap::OccupancyOcTreeBase<RoomNode> {
 public:
  static constexpr const char* kTreeType = "RoomRadarOcTree";

  explicit RoomOcTree(double resolution_m);
  [[nodiscard]] RoomOcTree* create() const override { return new RoomOcTree(resolution); }
  [[nodiscard]] std::string getTreeType() const override { return kTreeType; }
  /// Eight leaves of one log-odds and no signed distance.
  bool isNodeCollapsible(const RoomNode* node) const override;

  /// The root, made where there is none.
  RoomNode& ensure_root();
  void remove_root();
  /// Child i, or null.
  [[nodiscard]] RoomNode* child(const RoomNode& node, unsigned i) const {
    return nodeChildExists(&node, i) ? const_cast<RoomNode*>(getNodeChild(&node, i)) : nullptr;
  }
  /// Child i, made where there is none.
  RoomNode& ensure_child(RoomNode& node, unsigned i) {
    return nodeChildExists(&node, i) ? *getNodeChild(&node, i) : *createNodeChild(&node, i);
  }
  /// Takes the children's greatest log-odds as the node's own, and merges them where they are collapsible.
  void summarise(RoomNode& node);
};

}  // namespace roomradar
