// tsdf_bricks.cpp: hash index of bricks, and look-ups in a brick's neighbourhood.
#include "mapping/octree/tsdf_bricks.hpp"

#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

static_assert(sizeof(TsdfSample) == 12);
constexpr int kBrickShift = 3;
static_assert(1 << kBrickShift == kBrickEdge);

}  // namespace

TsdfBricks::TsdfBricks(const std::vector<VoxelIndex>& firsts) : bricks_(firsts.size()) {
  by_code_.reserve(firsts.size());
  for (std::size_t b = 0; b < firsts.size(); ++b) {
    bricks_[b].first = firsts[b];
    by_code_.emplace(voxel_key(firsts[b]), b);
  }
}

std::size_t TsdfBricks::find(const VoxelIndex& first) const {
  const auto found = by_code_.find(voxel_key(first));
  return found == by_code_.end() ? kNone : found->second;
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
