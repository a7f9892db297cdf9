// sample_bricks.hpp: a static map's signed distances in small dense cubes, to find neighbours fast.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "mapping/octree/static_map.hpp"

namespace roomradar {

struct BrickSample {
  float distance_m = 0.0F;
  float weight = 0.0F;  ///< as SurfaceSample's; 0: nothing is known here
  Rgb colour;
  bool has_colour : 1 = false;
  bool guessed : 1 = false;  ///< from its neighbours: nothing was measured here

  [[nodiscard]] bool known() const { return weight > 0.0F; }
};

inline constexpr int kBrickEdge = 8;                                     // voxels, a power of two
inline constexpr int kBrickSize = kBrickEdge * kBrickEdge * kBrickEdge;  // voxels

struct Brick {
  VoxelIndex first = VoxelIndex::Zero();  ///< its lowest voxel, a multiple of kBrickEdge
  std::array<BrickSample, kBrickEdge * kBrickEdge * kBrickEdge> samples;
};

/// Bricks that hold at least one sample, in the order of the octree.
class SampleBricks {
 public:
  SampleBricks(const StaticMap& map, float min_weight);
  /// Of the samples in a box alone.
  SampleBricks(const StaticMap& map, float min_weight, const Eigen::AlignedBox3d& box_world);

  [[nodiscard]] const std::vector<Brick>& bricks() const { return bricks_; }
  /// Samples may be changed; where the bricks are may not.
  [[nodiscard]] std::vector<Brick>& bricks() { return bricks_; }
  static constexpr std::size_t kNone = ~std::size_t{0};
  /// Position in bricks() of the brick whose lowest voxel is `first`, or kNone.
  [[nodiscard]] std::size_t find(const VoxelIndex& first) const;

 private:
  using VisitSamples = std::function<void(const std::function<void(const SurfaceSample&)>&)>;
  SampleBricks(const VisitSamples& visit_samples, float min_weight);

  std::vector<Brick> bricks_;
  std::unordered_map<std::uint64_t, std::size_t> by_place_;
};

/// The lowest voxel of the brick that a voxel lies in.
inline VoxelIndex brick_of(const VoxelIndex& voxel) {
  return voxel.unaryExpr([](int v) { return v & ~(kBrickEdge - 1); });
}

/// Position of a voxel in its brick's arrays; offsets in 0..kBrickEdge-1.
inline std::size_t brick_offset(const Eigen::Vector3i& offset) {
  return static_cast<std::size_t>((offset.z() * kBrickEdge + offset.y()) * kBrickEdge + offset.x());
}

/// A brick and its 26 neighbours, to read across its borders.
class BrickNeighbourhood {
 public:
  BrickNeighbourhood(const SampleBricks& bricks, std::size_t centre);

  struct Place {
    std::size_t brick = SampleBricks::kNone;
    std::size_t offset = 0;
  };
  /// Of a voxel given relative to the centre brick's lowest, each coordinate in -kBrickEdge..2*kBrickEdge-1.
  [[nodiscard]] Place place(const Eigen::Vector3i& relative) const;

 private:
  std::array<std::size_t, 27> around_{};
};

}  // namespace roomradar
