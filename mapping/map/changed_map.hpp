// changed_map.hpp: transfers textures to surfaces that were extracted again; saves a map whose octree was
// changed since it was loaded.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "mapping/map/map_folder.hpp"
#include "mapping/texture/earlier_texture.hpp"

namespace roomradar {

using EarlierTextures = std::vector<std::unique_ptr<const EarlierTexture>>;

/// Appends the map's texture and mesh to `earlier` if the texture fits the mesh. Throws Error if the texture
/// is damaged.
/// @param T_world_map  maps points from the map's world frame to the world frame in which `earlier` is looked
///                     up
void add_texture_of(const SavedMap& map, const Eigen::Isometry3d& T_world_map, EarlierTextures& earlier);

/// Bakes the texture of the map's present surface from earlier textures whose surface is within 2 cm.
/// Elsewhere the texture has the mesh's colours. Removes the map's texture if `earlier` is empty. Erases flat
/// triangles of the mesh (erase_flat_triangles()).
void renew_texture(const EarlierTextures& earlier, SavedMap& map);

/// Saves a map with changes of its octree: extracts the whole surface again, carries the texture over, and
/// surveys the coverage. Records the number of changes in the map's settings. Without changes, saves the map
/// as it is. Throws Error as save_map() does.
void save_changed_map(SavedMap& map, std::size_t changes, const std::filesystem::path& folder);

}  // namespace roomradar
