// room_octree.hpp: the node type of our .ot files, and an octree of OctoMap's that reads and writes them.
// A StaticMap is written in this form node by node; the tree is for programs that open the file by OctoMap's
// own AbstractOcTree::read(). Besides static_map_file.cpp nobody includes it, or OctoMap.
#pragma once
#include <octomap/OcTreeNode.h>
#include <octomap/OccupancyOcTreeBase.h>

#include <cstdint>
#include <iosfwd>
#include <string>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Log-odds of exactly 0 is a probability of one half: nothing known. Leaves hidden behind a surface have
/// that and a signed distance; what has neither is not stored. Only finest leaves have a signed distance
/// (weight > 0).
class RoomNode : public octomap::OcTreeNode {
 public:
  float distance_m = 0.0F;
  float weight = 0.0F;
  Rgb colour;
  std::uint8_t colour_count = 0;  ///< > 0: it has a colour

  [[nodiscard]] bool has_sample() const { return weight > 0.0F; }
  void copyData(const RoomNode& from);
  bool operator==(const RoomNode& other) const;

  /// In .ot: log-odds, then a byte that says whether a sample follows.
  std::ostream& writeData(std::ostream& stream) const;
  std::istream& readData(std::istream& stream);
};

class RoomOcTree : public octomap::OccupancyOcTreeBase<RoomNode> {
 public:
  static constexpr const char* kTreeType = "RoomRadarOcTree";

  explicit RoomOcTree(double resolution_m);
  [[nodiscard]] RoomOcTree* create() const override { return new RoomOcTree(resolution); }
  [[nodiscard]] std::string getTreeType() const override { return kTreeType; }
  /// Eight leaves of one log-odds and no signed distance.
  bool isNodeCollapsible(const RoomNode* node) const override;
};

}  // namespace roomradar
