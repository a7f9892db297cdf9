// tile_surface.hpp: extracts the surface of one tile, without cracks to the neighbouring tiles.
#pragma once
#include "mapping/building/tile_grid.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Extracts a tile's part of a building's surface: the triangles with a centre in the tile's cube. The tiles
/// together are the surface of the whole map. Tiles are extracted independently, without cracks between them:
/// simplification does not move vertices that two tiles share, so they have bit-identical coordinates in
/// both. Colours as in extract_surface().
/// @param map  must contain all samples within kSurfaceReach_voxels of the tile
Mesh extract_tile_surface(const StaticMap& map, const TileGrid& grid, const TileIndex& tile,
                          const SurfaceConfig& config = {});

}  // namespace roomradar
