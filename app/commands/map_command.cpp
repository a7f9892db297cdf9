// map_command.cpp: roomradar map info|verify|export: describes, checks and exports a saved map.
#include "app/commands/map_command.hpp"

#include <cstdio>

#include "mapping/map/map_folder.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/surface/unknown_surface.hpp"

namespace roomradar {

int run(const MapInfoOptions& options) {
  std::printf("%s", describe(load_map_info(options.map)).c_str());
  return 0;
}

int run(const MapVerifyOptions& options) {
  const std::vector<std::string> faults = verify_map(options.map);
  for (const std::string& fault : faults) std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
  if (!faults.empty()) return 1;
  std::printf("%s: sound\n", options.map.c_str());
  return 0;
}

int run(const MapExportOptions& options) {
  if (options.unknown) {
    require_outside_maps(options.path);
    const SavedMap map = load_map(options.map);
    write_mesh(unknown_surface(map.octree, map.mesh).mesh_world, options.path);
  } else {
    export_map(options.map, options.path);
  }
  std::printf("%s written\n", options.path.c_str());
  return 0;
}

}  // namespace roomradar
