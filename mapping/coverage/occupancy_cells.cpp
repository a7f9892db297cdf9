// occupancy_cells.cpp: counts the free volume of each cell.
#include "mapping/coverage/occupancy_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/types/voxel_key.hpp"

namespace roomradar {

OccupancyCells occupancy_cells(const StaticMap& map, double cell_m) {
  using Eigen::Vector3i;
  constexpr double kMostCells = 16e6;
  OccupancyCells grid;
  Vector3i low = Vector3i::Constant(std::numeric_limits<int>::max());
  Vector3i high = Vector3i::Constant(std::numeric_limits<int>::min());
  map.visit_leaves([&](const MapLeaf& leaf) {
    if (leaf.log_odds == 0.0F) return;
    low = low.cwiseMin(leaf.lowest_voxel);
    high = high.cwiseMax(leaf.lowest_voxel + Vector3i::Constant(leaf.edge_voxels));
  });
  if ((low.array() >= high.array()).any()) return grid;
  int edge_voxels = std::max(1, static_cast<int>(std::lround(cell_m / map.resolution_m())));
  while (((high - low).cast<double>() / edge_voxels).prod() > kMostCells) ++edge_voxels;
  grid.cell_m = edge_voxels * map.resolution_m();
  grid.first = low.unaryExpr([&](int v) { return floor_div(v, edge_voxels); });
  grid.size =
      high.unaryExpr([&](int v) { return floor_div(v - 1, edge_voxels); }) - grid.first + Vector3i::Ones();
  grid.cells.assign(static_cast<std::size_t>(grid.size.cast<std::int64_t>().prod()), Occupancy::kUnknown);
  grid.occupied_world = map.counts().occupied_world;
  std::vector<std::int64_t> free_voxels(grid.cells.size(), 0);
  map.visit_leaves([&](const MapLeaf& leaf) {
    if (leaf.log_odds == 0.0F) return;
    const Vector3i end = leaf.lowest_voxel + Vector3i::Constant(leaf.edge_voxels);
    const Vector3i from = leaf.lowest_voxel.unaryExpr([&](int v) { return floor_div(v, edge_voxels); });
    const Vector3i to = end.unaryExpr([&](int v) { return floor_div(v - 1, edge_voxels); });
    for (int z = from.z(); z <= to.z(); ++z)
      for (int y = from.y(); y <= to.y(); ++y)
        for (int x = from.x(); x <= to.x(); ++x) {
          const Vector3i cell(x, y, z);
          const std::size_t i = grid.index(cell - grid.first);
          if (leaf.log_odds > 0.0F) {
            grid.cells[i] = Occupancy::kOccupied;
            continue;
          }
          const Vector3i shared = end.cwiseMin((cell + Vector3i::Ones()) * edge_voxels) -
                                  leaf.lowest_voxel.cwiseMax(cell * edge_voxels);
          free_voxels[i] += shared.cast<std::int64_t>().prod();
        }
  });
  const std::int64_t volume_voxels = static_cast<std::int64_t>(edge_voxels) * edge_voxels * edge_voxels;
  for (std::size_t i = 0; i < grid.cells.size(); ++i)
    if (grid.cells[i] == Occupancy::kUnknown && 2 * free_voxels[i] >= volume_voxels)
      grid.cells[i] = Occupancy::kFree;
  return grid;
}

}  // namespace roomradar
