// tile_loading.hpp: reads one tile of a building and builds its trees, on any thread.
#pragma once
#include <cstddef>
#include <filesystem>

#include "mapping/building/building_info.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/depth/raster_mesh.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

struct LoadedTile {
  Mesh mesh;               ///< surface in the world, without normals and colours
  TriangleTree tree;       ///< of `mesh`
  RasterMesh pieces;       ///< of `tree`
  UnknownSurface unknown;  ///< frontier of unknown space within the tile; its mesh_world is empty
  TriangleTree unknown_tree;
};

/// Reads a tile, without its octree. The frontier of unknown space is open on faces of the cube that adjoin
/// another tile, since that tile contains the frontier there.
///
/// Thread safe. Throws Error naming the file and the fault if a file is missing or damaged.
/// @param tile         index in building.tiles
/// @param has_unknown  false: the frontier of unknown space is left empty, and its file is not read
LoadedTile load_tile(const BuildingInfo& building, const std::filesystem::path& folder, std::size_t tile,
                     bool has_unknown);

}  // namespace roomradar
