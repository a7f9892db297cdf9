// building_map_commands.cpp: prints, checks, and chooses the format by the extension.
#include "app/building/building_map_commands.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/building/building_check.hpp"
#include "app/building/building_summary.hpp"
#include "app/media/floor_plan.hpp"
#include "app/media/picture_file.hpp"
#include "mapping/building/building_map.hpp"
#include "mapping/map/map_files.hpp"
#include "mapping/mesh/assimp_import.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

void export_plan(const MapExportOptions& options) {
  const BuildingSummary summary = summarise_building(options.map);
  if (summary.floors.empty()) throw Error(options.map + ": has no floor to draw a plan of");
  std::vector<double> heights_m;
  for (const BuildingFloor& floor : summary.floors) heights_m.push_back(floor.height_m);
  write_png(draw_floor_plans(load_building_mesh(summary.info, options.map), heights_m), options.path);
}

}  // namespace

int run_on_building(const MapInfoOptions& options) {
  const BuildingSummary summary = summarise_building(options.map);
  if (options.json)
    std::printf("%s\n", json_of(summary).dump(2).c_str());
  else
    std::fputs(describe(summary).c_str(), stdout);
  return 0;
}

int run_on_building(const MapVerifyOptions& options) {
  const std::vector<std::string> faults = verify_building(options.map);
  for (const std::string& fault : faults) std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
  if (!faults.empty()) {
    std::fprintf(stderr,
                 "roomradar: delete the named files and run `roomradar building` again, which makes them\n");
    return 1;
  }
  std::printf("%s: sound\n", options.map.c_str());
  return 0;
}

int run_on_building(const MapExportOptions& options) {
  const std::string extension = lower_extension(options.path);
  if (options.unknown)
    throw Error(options.map + ": is the map of a building; --unknown takes the map of one room");
  require_outside_maps(options.path);
  if (extension == ".ot" || extension == ".bt") {
    const StaticMap octree = load_building_octree(read_building(options.map), options.map);
    extension == ".ot" ? octree.write_ot(options.path) : octree.write_bt(options.path);
  } else if (extension == ".png") {
    export_plan(options);
  } else if (extension == ".ply" || extension == ".obj" || extension == ".stl" || extension == ".glb") {
    write_mesh(load_building_mesh(read_building(options.map), options.map), options.path);
  } else {
    throw Error(
        options.path + ": the extension \"" + extension +
        "\" is not an export format for a building; use .ply .obj .stl or .glb for the surface, .ot or "
        ".bt for the octree, .png for a plan of each floor");
  }
  std::printf("%s written\n", options.path.c_str());
  return 0;
}

}  // namespace roomradar
