// tile_surface.hpp: the surface of one tile, which meets its neighbours' without a crack.
#pragma once
#include "mapping/building/tile_grid.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Extracts the part of a building's surface that belongs to a tile: the triangles whose centre is in its
/// cube. All tiles together are the surface of the whole map: a vertex that two tiles share has equal
/// coordinates in both, bit for bit, although each is extracted on its own. For this, vertices on the seam
/// stay where they were measured; only those inside are simplified. Colours as in extract_surface().
/// @param map  must hold the tile's samples and all within kSurfaceReach_voxels of it
Mesh extract_tile_surface(const StaticMap& map, const TileGrid& grid, const TileIndex& tile,
                          const SurfaceConfig& config = {});

}  // namespace roomradar
