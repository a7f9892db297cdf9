// tsdf_bricks.cpp: hash index of bricks, and look-ups in a brick's neighbourhood.
#include "mapping/surface/tsdf_bricks.hpp"

#include <bit>

#include "mapping/types/fibonacci_hash.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

static_assert(sizeof(TsdfSample) == 12);
constexpr int kBrickShift = 2;
static_assert(1 << kBrickShift == kBrickEdge);

constexpr std::uint32_t kEmpty = ~std::uint32_t{0};

// Each step can be inverted, so different bricks have different hashes.
std::uint64_t hash_of(const VoxelIndex& first) {
  const std::uint64_t hash = fibonacci_hash(voxel_key(first));
  return hash ^ hash >> 32U;
}

}  // namespace

TsdfBricks::TsdfBricks(const std::vector<VoxelIndex>& firsts)
    : bricks_(firsts.size()), slots_(std::bit_ceil(2 * firsts.size() + 1)) {
  for (std::size_t b = 0; b < firsts.size(); ++b) {
    bricks_[b].first = firsts[b];
    const std::uint64_t hash = hash_of(firsts[b]);
    std::size_t slot = hash & (slots_.size() - 1);
    while (slots_[slot].brick != kEmpty) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = {hash, static_cast<std::uint32_t>(b)};
  }
}

std::size_t TsdfBricks::find(const VoxelIndex& first) const {
  const std::uint64_t hash = hash_of(first);
  for (std::size_t slot = hash & (slots_.size() - 1); slots_[slot].brick != kEmpty;
       slot = (slot + 1) & (slots_.size() - 1))
    if (slots_[slot].hash == hash) return slots_[slot].brick;
  return kNone;
}

BrickNeighbourhood::BrickNeighbourhood(const TsdfBricks& bricks, std::size_t centre) {
  const VoxelIndex first = bricks.bricks()[centre].first;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x)
        around_[static_cast<std::size_t>((z * 3 + y) * 3 + x)] =
            bricks.find(first + kBrickEdge * Eigen::Vector3i(x - 1, y - 1, z - 1));
}

BrickNeighbourhood::SampleIndex BrickNeighbourhood::index_of(const Eigen::Vector3i& relative) const {
  const Eigen::Vector3i which = relative.unaryExpr([](int v) { return (v >> kBrickShift) + 1; });
  const Eigen::Vector3i offset = relative.unaryExpr([](int v) { return v & (kBrickEdge - 1); });
  return {around_[static_cast<std::size_t>((which.z() * 3 + which.y()) * 3 + which.x())],
          brick_offset(offset)};
}

}  // namespace roomradar
