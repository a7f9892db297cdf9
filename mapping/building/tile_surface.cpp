// tile_surface.cpp: the part of the surface in a tile's cube.
#include "mapping/building/tile_surface.hpp"

namespace roomradar {

Mesh extract_tile_surface(const StaticMap& map, const TileGrid& grid, const TileIndex& tile,
                          const SurfaceConfig& config) {
  return extract_surface_part(map, box_of(grid, tile), config).mesh;
}

}  // namespace roomradar
