// tileset.hpp: describes a building's tiles for viewers of 3D Tiles.
#pragma once
#include <filesystem>
#include <string>

#include "mapping/building/building_info.hpp"

namespace roomradar {

inline constexpr const char* kTilesetFile = "tileset.json";

/// Returns the text of tileset.json, which Cesium and other viewers of 3D Tiles 1.1 open. It describes an
/// octree of boxes over the tiles; the leaves name the tiles' surfaces (.glb). Source: Open Geospatial
/// Consortium, 3D Tiles Specification 1.1, 22-025r4.
std::string tileset_text(const BuildingInfo& info);
/// Writes tileset.json. Throws Error if it cannot be written.
void write_tileset(const BuildingInfo& info, const std::filesystem::path& folder);

}  // namespace roomradar
