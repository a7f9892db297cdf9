// changed_map.cpp: derives surface, texture and coverage from a changed octree.
#include "mapping/map/changed_map.hpp"

#include <string>

#include "mapping/coverage/coverage.hpp"
#include "mapping/map/map_texture.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/surface/surface_extraction.hpp"

namespace roomradar {

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
