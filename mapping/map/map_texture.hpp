// map_texture.hpp: the textures of maps whose surface was extracted again.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "mapping/map/map_folder.hpp"
#include "mapping/texture/earlier_texture.hpp"

namespace roomradar {

using EarlierTextures = std::vector<std::unique_ptr<const EarlierTexture>>;

/// Adds the map's texture, if it has one that fits. Throws Error if the texture is damaged.
/// @param T_world_map  maps points from the map's world to the world of the lookups
void add_texture_of(const SavedMap& map, const Eigen::Isometry3d& T_world_map, EarlierTextures& earlier);

/// Bakes the texture of the map's present surface from earlier textures, where they are within 2 cm of it.
/// Elsewhere the texture has the surface's colours. Sets no texture if there are no earlier ones.
void renew_texture(const EarlierTextures& earlier, SavedMap& map);

}  // namespace roomradar
