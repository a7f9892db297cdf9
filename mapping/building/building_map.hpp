// building_map.hpp: a building's tiles as one mesh or one octree, and its keyframes as one database.
#pragma once
#include <filesystem>

#include "mapping/building/building_info.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

// All functions throw Error naming the file and the fault if a file is missing or damaged.

/// Returns the meshes of all tiles as one. Vertices of different tiles at the same position, bit for bit,
/// become one vertex. The origin is that of the first tile.
Mesh load_building_mesh(const BuildingInfo& info, const std::filesystem::path& folder);

/// Returns the octrees of all tiles as one.
StaticMap load_building_octree(const BuildingInfo& info, const std::filesystem::path& folder);

/// Returns the keyframes of all placed recordings at their poses in the building, with an index of their
/// features. Throws Error if the building has none, as buildings made by an earlier version do.
KeyframeDatabase load_building_keyframes(const BuildingInfo& info, const std::filesystem::path& folder);

}  // namespace roomradar
