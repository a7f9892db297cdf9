// octomap_tree.hpp: node type of the project's .ot map files, and an OctoMap octree that reads and writes
// these files. StaticMap itself writes the format node by node. The class OctoMapTree is for programs that
// open the file with OctoMap's AbstractOcTree::read(). Only static_map_file.cpp includes this header and
// OctoMap.
#pragma once
#include <octomap/OcTreeNode.h>
#include <octomap/OccupancyOcTreeBase.h>

#include <cstdint>
#include <iosfwd>
#include <string>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Node with log-odds. Leaves at the two finest depths may also have a signed distance, if weight > 0.
/// Log-odds of exactly 0 (probability one half) mean unknown. Leaves behind a surface may have a signed
/// distance although their occupancy is unknown. Unknown leaves without signed distance are not stored.
class OctoMapNode : public octomap::OcTreeNode {
 public:
  float distance_m = 0.0F;
  float weight = 0.0F;
  Rgb colour;
  std::uint8_t colour_count = 0;  ///< the node has a colour if this is > 0

  [[nodiscard]] bool has_sample() const { return weight > 0.0F; }
  void copyData(const OctoMapNode& from);
  bool operator==(const OctoMapNode& other) const;

  /// Writes the node in .ot format: log-odds, then one byte that is 1 if a sample follows, else 0.
  std::ostream& writeData(std::ostream& stream) const;
  std::istream& readData(std::istream& stream);
};

class OctoMapTree : public octomap::OccupancyOcTreeBase<OctoMapNode> {
 public:
  static constexpr const char* kTreeType = "RoomRadarOcTree";

  explicit OctoMapTree(double resolution_m);
  [[nodiscard]] OctoMapTree* create() const override { return new OctoMapTree(resolution); }
  [[nodiscard]] std::string getTreeType() const override { return kTreeType; }
  /// Returns true if all eight children are leaves with equal log-odds and without signed distance.
  bool isNodeCollapsible(const OctoMapNode* node) const override;
};

}  // namespace roomradar
