// map_command.cpp: roomradar map info|verify|export: describes, checks and exports a saved map.
#include <cstdio>

#include "app/commands/commands.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/surface/unknown_surface.hpp"

namespace roomradar {

int run(const MapInfoCommand& command) {
  std::printf("%s", describe(load_map_info(command.map)).c_str());
  return 0;
}

int run(const MapVerifyCommand& command) {
  const std::vector<std::string> faults = verify_map(command.map);
  for (const std::string& fault : faults) std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
  if (!faults.empty()) return 1;
  std::printf("%s: sound\n", command.map.c_str());
  return 0;
}

int run(const MapExportCommand& command) {
  if (command.unknown) {
    require_outside_maps(command.path);
    const SavedMap map = load_map(command.map);
    write_mesh(unknown_surface(map.octree, map.mesh).mesh_world, command.path);
  } else {
    export_map(command.map, command.path);
  }
  std::printf("%s written\n", command.path.c_str());
  return 0;
}

}  // namespace roomradar
