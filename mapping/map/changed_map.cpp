// changed_map.cpp: derives surface, texture and coverage from a changed octree; bakes textures from earlier
// ones.
#include "mapping/map/changed_map.hpp"

#include <string>
#include <utility>

#include "mapping/coverage/coverage.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/mesh/ply_file.hpp"
#include "mapping/surface/surface_extraction.hpp"
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

void save_changed_map(SavedMap& map, std::size_t changes, const std::filesystem::path& folder) {
  if (changes > 0) {
    EarlierTextures earlier;
    add_texture_of(map, Eigen::Isometry3d::Identity(), earlier);
    map.mesh = extract_surface(map.octree.load(), surface_config_of(map.info));
    renew_texture(earlier, map);
    map.coverage_png = survey_coverage(map.octree.load(), map.mesh, map.trajectory).picture_png;
  }
  map.info.settings["committed"] = std::to_string(changes);
  save_map(folder, map);
}

}  // namespace roomradar
