// map_texture.cpp: bakes the texture of a re-extracted surface from earlier textures.
#include "mapping/map/map_texture.hpp"

#include <utility>

#include "mapping/mesh/ply_file.hpp"
#include "mapping/texture/texture_bake.hpp"

namespace roomradar {

void add_texture_of(const SavedMap& map, const Eigen::Isometry3d& T_world_map, EarlierTextures& earlier) {
  if (const auto texture = fitting_texture(map))
    earlier.push_back(std::make_unique<const EarlierTexture>(transformed(map.mesh, T_world_map), *texture));
}

void renew_texture(const EarlierTextures& earlier, SavedMap& map) {
  map.texture = std::shared_ptr<const SurfaceTexture>();
  if (earlier.empty()) return;
  erase_flat_triangles(map.mesh);  // so that the texture fits the mesh that is read from the map
  SurfaceTexture texture = bake_texture(map.mesh, {}, earlier);
  if (!texture.corners.empty()) map.texture = std::make_shared<const SurfaceTexture>(std::move(texture));
}

}  // namespace roomradar
