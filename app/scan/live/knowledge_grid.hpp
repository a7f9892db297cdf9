// knowledge_grid.hpp: coarse grid with the total weight of a running scan's measurements per cell.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "app/scan/live/anchors.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Level of knowledge of a surface point, by the total weight of its measurements.
enum class Knowledge : std::uint8_t {
  kNone,  ///< pixel without depth
  kNew,   ///< weight below SurfaceConfig::min_weight: not in the map's surface
  kThin,  ///< weight below 5 times SurfaceConfig::min_weight
  kWell,
};

/// Sums the weights of measurements in cells of 4 cm. Uses every 8th pixel in both directions, up to 5 m
/// depth. A frame adds to a cell about the weight that the map's fusion would add, (sigma at 1 m / sigma)^2:
/// each sample's weight is divided by the number of the frame's samples expected in its cell. Takes about 1
/// ms per frame.
class KnowledgeGrid {
 public:
  static constexpr int kStep_px = 8;
  static constexpr double kCell_m = 0.04;
  static constexpr int kBlockSide = 4;  ///< cells are stored in cubes of this many per side

  /// Adds a frame's measurements.
  /// @param anchor  index of the frame's anchor (anchors.hpp), in whose frame the measurements are stored
  void add(const Frame& frame, std::size_t anchor, const Eigen::Isometry3d& T_anchor_camera,
           const Eigen::Isometry3d& T_world_anchor);
  /// Moves all measurements to the anchors' current poses. Discards measurements of removed anchors.
  void move(const AnchorPoses& T_world_anchor);

  /// Returns the knowledge at every kStep_px-th pixel of the depth image, from pixel kStep_px / 2 on.
  [[nodiscard]] Image<Knowledge> knowledge_of(const Frame& frame,
                                              const Eigen::Isometry3d& T_world_camera) const;

  /// Returns the knowledge at a point; kNew if the cell has no measurements.
  [[nodiscard]] Knowledge at(const Eigen::Vector3d& p_world) const;

  /// Returns the fraction of kWell cells among the cells that are kThin or kWell; 0 if there are none.
  [[nodiscard]] double well_known_fraction() const;

 private:
  using Weights = std::array<float, kBlockSide * kBlockSide * kBlockSide>;  ///< of a block's cells, x fastest
  using Blocks = std::unordered_map<std::uint64_t, Weights>;
  static void add_weight(Blocks& blocks, const Eigen::Vector3d& p, float weight);

  std::vector<Blocks> in_anchor_;
  Blocks in_world_;
};

}  // namespace roomradar
