// tile_grid.hpp: the cubes into which a building's octree is split, and the surface of one of them.
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Integer coordinates of a tile.
using TileIndex = Eigen::Vector3i;

/// A grid of cubes on the octree's voxels. Tile `index` begins at voxel index * edge_voxels. Along z, it
/// begins a quarter of an edge lower, so that no border of tiles cuts the floor at z = 0.
struct TileGrid {
  double resolution_m = 0.01;  ///< edge of a voxel
  int edge_voxels = 512;       ///< a power of two, 64 to 4,096
};
/// Throws Error naming the field and the rule if a value is out of range.
void require_valid(const TileGrid& grid);

inline VoxelIndex lowest_voxel(const TileGrid& grid, const TileIndex& tile) {
  return tile * grid.edge_voxels - VoxelIndex(0, 0, grid.edge_voxels / 4);
}
inline double edge_m(const TileGrid& grid) { return grid.edge_voxels * grid.resolution_m; }
/// Returns the tile's cube in the world, m.
Eigen::AlignedBox3d box_of(const TileGrid& grid, const TileIndex& tile);
/// Returns the tile that contains a point.
TileIndex tile_at(const TileGrid& grid, const Eigen::Vector3d& p_world);

/// Returns the tiles with a sample of the map within `margin_voxels` (or up to 3 voxels more) of their cubes,
/// ordered by is_before().
std::vector<TileIndex> tiles_of(const StaticMap& map, const TileGrid& grid, int margin_voxels);

/// Returns the tiles that have a free or occupied voxel, in the same order.
std::vector<TileIndex> observed_tiles(const StaticMap& map, const TileGrid& grid);

/// Orders tiles by z, then y, then x.
bool is_before(const TileIndex& a, const TileIndex& b);

/// Returns a tile's name, such as `3_-1_0`.
std::string name_of(const TileIndex& tile);
/// Returns the tile with this name. Throws Error if the name is not of this form.
TileIndex tile_of_name(std::string_view name);

/// Extracts a tile's part of a building's surface: the triangles with a centre in the tile's cube. The tiles
/// together are the surface of the whole map. Tiles are extracted independently, without cracks between them:
/// simplification does not move vertices that two tiles share, so they have bit-identical coordinates in
/// both. Colours as in extract_surface().
/// @param map  must contain all samples within kSurfaceReach_voxels of the tile
Mesh extract_tile_surface(const StaticMap& map, const TileGrid& grid, const TileIndex& tile,
                          const SurfaceConfig& config = {});

}  // namespace roomradar
