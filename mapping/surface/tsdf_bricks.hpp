// tsdf_bricks.hpp: signed distances of a static map (TSDF), copied into dense bricks of 4 x 4 x 4 cells for
// fast access to neighbours.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/octree/static_map.hpp"

namespace roomradar {

struct TsdfSample {
  float distance_m = 0.0F;
  float weight = 0.0F;  ///< weight as in SurfaceSample; 0: unknown
  Rgb colour;
  bool has_colour : 1 = false;
  bool extrapolated : 1 = false;  ///< extrapolated from neighbouring samples, not measured
  bool mirrored : 1 = false;      ///< copy of the other grid's sample; see tsdf_levels.hpp

  [[nodiscard]] bool known() const { return weight > 0.0F; }
};

/// Edge of a brick in cells, a power of two. Bricks of 8 cells took 1.4 times the memory and 1.1 times the
/// time of extraction: three quarters of their samples were unknown.
inline constexpr int kBrickEdge = 4;
inline constexpr int kBrickSize = kBrickEdge * kBrickEdge * kBrickEdge;  ///< number of cells in a brick

struct Brick {
  VoxelIndex first = VoxelIndex::Zero();  ///< lowest cell; coordinates are multiples of kBrickEdge
  std::array<TsdfSample, kBrickSize> samples;
};

/// Bricks of samples, with a hash index by their lowest cell.
class TsdfBricks {
 public:
  /// Makes bricks of unknown samples at these lowest cells, which must be distinct.
  explicit TsdfBricks(const std::vector<VoxelIndex>& firsts);

  [[nodiscard]] const std::vector<Brick>& bricks() const { return bricks_; }
  /// Returns the bricks. Callers may change samples, but must not add, remove or move bricks.
  [[nodiscard]] std::vector<Brick>& bricks() { return bricks_; }
  static constexpr std::size_t kNone = ~std::size_t{0};
  /// Returns the index, in bricks(), of the brick whose lowest cell is `first`; kNone if there is none.
  [[nodiscard]] std::size_t find(const VoxelIndex& first) const;

 private:
  std::vector<Brick> bricks_;
  /// Open addressing: a brick is in the first slot from its hash on that no other takes.
  struct Slot {
    std::uint64_t hash = 0;                   ///< different for different lowest cells
    std::uint32_t brick = ~std::uint32_t{0};  ///< index in bricks_; the default: the slot is empty
  };
  std::vector<Slot> slots_;  ///< more than twice as many as bricks, a power of two
};

/// Returns the lowest cell of the brick that contains `cell`.
inline VoxelIndex brick_of(const VoxelIndex& cell) {
  return cell.unaryExpr([](int v) { return v & ~(kBrickEdge - 1); });
}

/// Returns the index into Brick::samples of the cell at `offset` from the brick's lowest cell. Each
/// coordinate must be in 0..kBrickEdge-1.
inline std::size_t brick_offset(const Eigen::Vector3i& offset) {
  return static_cast<std::size_t>((offset.z() * kBrickEdge + offset.y()) * kBrickEdge + offset.x());
}

/// A brick and its 26 neighbours, for access across brick borders.
class BrickNeighbourhood {
 public:
  BrickNeighbourhood(const TsdfBricks& bricks, std::size_t centre);

  struct SampleIndex {
    std::size_t brick = TsdfBricks::kNone;
    std::size_t offset = 0;
  };
  /// Returns the brick and index of the cell at `relative` from the centre brick's lowest cell. Each
  /// coordinate must be in -kBrickEdge..2*kBrickEdge-1.
  [[nodiscard]] SampleIndex index_of(const Eigen::Vector3i& relative) const;

 private:
  std::array<std::size_t, 27> around_{};
};

}  // namespace roomradar
