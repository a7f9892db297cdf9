// building_map.hpp: a building's tiles as one mesh or one octree, and its keyframes as one database.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "mapping/building/building_info.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

// The load functions throw Error naming the file and the fault if a file is missing or damaged.

/// Returns the meshes of all tiles as one. Vertices of different tiles at the same position, bit for bit,
/// become one vertex. The mesh's origin is that of the first tile's mesh.
Mesh load_building_mesh(const BuildingInfo& info, const std::filesystem::path& folder);

/// Returns the octrees of all tiles as one.
StaticMap load_building_octree(const BuildingInfo& info, const std::filesystem::path& folder);

/// Returns the keyframes of all placed recordings at their poses in the building, with an index of their
/// features, as recognise_place() needs them, but without patches. Throws Error if the building has no
/// keyframes, which is the case if it was made by an earlier version.
/// @param max_bytes  max memory of the result; 0: no limit. To meet the limit, keyframes with a view similar
///                   to an earlier keyframe's are left out. At least one keyframe per recording is kept
KeyframeDatabase load_building_keyframes(const BuildingInfo& info, const std::filesystem::path& folder,
                                         std::size_t max_bytes = 0);

/// Returns the indices of the keyframes, in order, whose view_distance() from the last one returned is at
/// least `min_step`. The first keyframe is always among them.
std::vector<std::size_t> distinct_views(std::span<const MapKeyframe> keyframes, double min_step);

}  // namespace roomradar
