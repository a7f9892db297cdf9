// tsdf_bricks.hpp: signed distances of a static map (TSDF), copied into dense bricks of 8 x 8 x 8 voxels for
// fast access to neighbours.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
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

inline constexpr int kBrickEdge = 8;  // edge of a brick in voxels, a power of two
inline constexpr int kBrickSize = kBrickEdge * kBrickEdge * kBrickEdge;  // number of voxels in a brick

struct Brick {
  VoxelIndex first = VoxelIndex::Zero();  ///< lowest voxel of the brick; coordinates are multiples of
                                          ///< kBrickEdge
  std::array<TsdfSample, kBrickEdge * kBrickEdge * kBrickEdge> samples;
};

/// Bricks of samples, with a hash index by their lowest voxel.
class TsdfBricks {
 public:
  /// Makes bricks of unknown samples at these lowest voxels, which must be distinct.
  explicit TsdfBricks(const std::vector<VoxelIndex>& firsts);

  [[nodiscard]] const std::vector<Brick>& bricks() const { return bricks_; }
  /// Returns the bricks. Callers may change samples, but must not add, remove or move bricks.
  [[nodiscard]] std::vector<Brick>& bricks() { return bricks_; }
  static constexpr std::size_t kNone = ~std::size_t{0};
  /// Returns the index, in bricks(), of the brick whose lowest voxel is `first`; kNone if there is none.
  [[nodiscard]] std::size_t find(const VoxelIndex& first) const;

 private:
  std::vector<Brick> bricks_;
  std::unordered_map<std::uint64_t, std::size_t> by_code_;
};

/// Returns the lowest voxel of the brick that contains `voxel`.
inline VoxelIndex brick_of(const VoxelIndex& voxel) {
  return voxel.unaryExpr([](int v) { return v & ~(kBrickEdge - 1); });
}

/// Returns the index into Brick::samples of the voxel at `offset` from the brick's lowest voxel. Each
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
  /// Returns the brick and index of the voxel at `relative` from the centre brick's lowest voxel. Each
  /// coordinate must be in -kBrickEdge..2*kBrickEdge-1.
  [[nodiscard]] SampleIndex index_of(const Eigen::Vector3i& relative) const;

 private:
  std::array<std::size_t, 27> around_{};
};

}  // namespace roomradar
