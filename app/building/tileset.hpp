// tileset.hpp: a building's tiles for viewers of 3D Tiles.
#pragma once
#include <filesystem>

#include "mapping/building/building_info.hpp"

namespace roomradar {

/// Writes `tileset.json`, which Cesium and other viewers of 3D Tiles 1.1 open: an octree of boxes over the
/// tiles, whose leaves have the tiles' surfaces (.glb). Throws Error if the file cannot be written. Source:
/// Open Geospatial Consortium, 3D Tiles Specification 1.1, 22-025r4.
void write_tileset(const BuildingInfo& info, const std::filesystem::path& folder);

}  // namespace roomradar
