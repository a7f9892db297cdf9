// tsdf_levels.hpp: signed distances of a static map in two grids of bricks, one for each size of cell.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/surface/tsdf_bricks.hpp"

namespace roomradar {

/// Edge of a coarse cell in voxels.
inline constexpr int kCoarseEdge = 2;
/// Number of bricks that a thread takes at a time.
inline constexpr std::size_t kBricksAtOnce = 256;

/// Samples of a map, at the size at which the octree stores them: a grid of voxels and a grid of coarse
/// cells. Coarse cell c covers the voxels 2 c and 2 c + 1 along each axis. Each node (a cube with an edge of
/// 4 voxels) belongs to one grid. A node belongs to the grid of voxels if it has a sample of a voxel. A node
/// without any sample also belongs to the grid of voxels if it is next to a node with a sample of a voxel.
/// All other nodes belong to the grid of coarse cells. Where the grids meet, each has mirrored samples of the
/// other, one node deep, so that algorithms on one grid find neighbours. A mirrored voxel is interpolated
/// between coarse cells; a mirrored coarse cell is the mean of its eight voxels, if all are known.
class TsdfLevels {
 public:
  /// Uses samples of weight min_weight or more, of cells that have a voxel in the box.
  TsdfLevels(const StaticMap& map, float min_weight, const Eigen::AlignedBox3d& box_world);

  TsdfBricks voxels;
  TsdfBricks coarse;

  /// Updates the mirrored samples after changes of the other grid.
  void mirror_coarse_in_voxels();
  void mirror_voxels_in_coarse();

 private:
  std::vector<VoxelIndex> coarse_beside_voxels_;  ///< nodes, each given by its lowest voxel divided by 4
  std::vector<VoxelIndex> voxels_beside_coarse_;
};

/// Returns the sample of a grid's cell; null if no brick has it.
const TsdfSample* sample_in(const TsdfBricks& bricks, const VoxelIndex& cell);

}  // namespace roomradar
