// octomap_tree.hpp: node type of roomradar's .ot files, and an OctoMap octree that reads and writes them.
// StaticMap writes this format node by node. The tree class is for programs that open the file with OctoMap's
// AbstractOcTree::read(). Only static_map_file.cpp includes this header and OctoMap.
#pragma once
#include <octomap/OcTreeNode.h>
#include <octomap/OccupancyOcTreeBase.h>

#include <cstdint>
#include <iosfwd>
#include <string>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Log-odds of exactly 0 (probability one half) mean unknown. Leaves hidden behind a surface may be unknown
/// and have a signed distance; leaves with neither are not stored. Only finest leaves have a signed distance
/// (weight > 0).
class OctoMapNode : public octomap::OcTreeNode {
 public:
  float distance_m = 0.0F;
  float weight = 0.0F;
  Rgb colour;
  std::uint8_t colour_count = 0;  ///< > 0: the node has a colour

  [[nodiscard]] bool has_sample() const { return weight > 0.0F; }
  void copyData(const OctoMapNode& from);
  bool operator==(const OctoMapNode& other) const;

  /// .ot format: log-odds, then a byte that is 1 if a sample follows, else 0.
  std::ostream& writeData(std::ostream& stream) const;
  std::istream& readData(std::istream& stream);
};

class OctoMapTree : public octomap::OccupancyOcTreeBase<OctoMapNode> {
 public:
  static constexpr const char* kTreeType = "RoomRadarOcTree";

  explicit OctoMapTree(double resolution_m);
  [[nodiscard]] OctoMapTree* create() const override { return new OctoMapTree(resolution); }
  [[nodiscard]] std::string getTreeType() const override { return kTreeType; }
  /// True for eight leaves with equal log-odds and no signed distance.
  bool isNodeCollapsible(const OctoMapNode* node) const override;
};

}  // namespace roomradar
