// map_command.cpp: roomradar map info|verify|export: describes, checks and exports a saved map.
#include "app/commands/commands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/report.hpp"
#include "app/cli/shell_line.hpp"
#include "app/objects/kept_objects.hpp"
#include "app/page/room_page.hpp"
#include "app/session/script/script.hpp"
#include "app/sources/recordings/recording_kinds.hpp"
#include "mapping/map/level_surfaces.hpp"
#include "mapping/map/map_export.hpp"
#include "mapping/map/map_files.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_history.hpp"
#include "mapping/map/map_info.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

nlohmann::json json_of(const MapInfo& info, const std::vector<LevelSurface>& surfaces, const Mesh& mesh) {
  nlohmann::json json = nlohmann::json::parse(to_json(info));
  json["surfaces"] = nlohmann::json::array();
  const std::vector<bool> is_floor = floor_among(surfaces, mesh);
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    json["surfaces"].push_back({{"floor", static_cast<bool>(is_floor[i])},
                                {"height_m", surfaces[i].height_m},
                                {"area_m2", surfaces[i].area_m2},
                                {"middle_m", to_json(surfaces[i].middle_world)}});
  return json;
}

/// Returns a line per level surface, from the lowest to the highest.
std::string describe(std::vector<LevelSurface> surfaces, const Mesh& mesh) {
  if (surfaces.empty()) return "level surfaces  none of 0.05 m2 and more\n";
  std::sort(surfaces.begin(), surfaces.end(),
            [](const auto& a, const auto& b) { return a.height_m < b.height_m; });
  const std::vector<bool> is_floor = floor_among(surfaces, mesh);
  const auto cm = [](double m) { return rounded(m, 2); };
  std::string text;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Eigen::Vector3d& p = surfaces[i].middle_world;
    std::array<char, 120> line{};
    format_classic(line.data(), line.size(), "%-16sz %.2f m, %.2f m2, middle at %.2f %.2f %.2f%s\n",
                   i == 0 ? "level surfaces" : "", cm(surfaces[i].height_m), surfaces[i].area_m2, cm(p.x()),
                   cm(p.y()), cm(p.z()), is_floor[i] ? " (floor)" : "");
    text += line.data();
  }
  if (std::find(is_floor.begin(), is_floor.end(), true) == is_floor.end())
    text += "                none is the floor: the map has surfaces below the lowest\n";
  return text;
}

/// Throws Error naming `roomradar check` if the path is a recording, and not a map.
void require_no_recording(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored) || std::filesystem::exists(std::filesystem::path(path) / "map.json", ignored))
    return;
  if (const std::string kind = recording_kind(path); !kind.empty())
    throw Error(path + ": is a recording (" + kind + "), not a map; `" + shell_line({"roomradar", "check", path}) +
                "` says what it holds, and `roomradar prescan` makes a map of it");
}

void export_page(const MapExportOptions& options, const std::filesystem::path& map) {
  require_outside_maps(options.path);
  require_writable(options.path);
  write_map_page(load_map(map), options.map, options.path);
}

}  // namespace

int run(const MapInfoOptions& options) {
  require_no_recording(options.map);
  const OpenedMap opened(options.map);
  const MapInfo info = load_map_info(opened.folder());
  const Mesh mesh = load_map_mesh(opened.folder());
  const std::vector<LevelSurface> surfaces = level_surfaces(mesh);
  if (options.json)
    std::printf("%s\n", json_of(info, surfaces, mesh).dump(2).c_str());
  else
    std::printf("%s%s", describe(info).c_str(), describe(surfaces, mesh).c_str());
  return 0;
}

int run(const MapVerifyOptions& options) {
  require_no_recording(options.map);
  const std::vector<std::string> faults = verify_map(options.map);
  for (const std::string& fault : faults) std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
  if (!faults.empty()) return 1;
  std::printf("%s: sound\n", options.map.c_str());
  return 0;
}

int run(const MapExportOptions& options) {
  require_no_recording(options.map);
  const OpenedMap opened(options.map);
  if (is_page(options.path)) {
    if (options.unknown)
      throw Error(options.path + ": --unknown writes a mesh; give a .ply, .obj, .stl or .glb file");
    export_page(options, opened.folder());
  } else if (options.unknown) {
    require_outside_maps(options.path);
    const SavedMap map = load_map(opened.folder());
    write_mesh(unknown_surface(map.octree.load(), map.mesh).mesh_world, options.path);
  } else {
    export_map(opened.folder(), options.path);
  }
  std::printf("%s written\n", options.path.c_str());
  return 0;
}

int run(const MapObjectsOptions& options) {
  require_no_recording(options.map);
  (void)load_map_info(options.map);
  const std::filesystem::path folder = std::filesystem::path(options.map) / kMapObjectsFolder;
  std::vector<KeptObject> objects = read_kept_objects(folder);
  const auto named = [&](const std::string& name) {
    return std::find_if(objects.begin(), objects.end(),
                        [&](const KeptObject& object) { return object.name == name; });
  };
  if (options.action != "list") {
    const auto found = named(options.names.front());
    if (found == objects.end())
      throw Error(options.map + ": no object in it has the name " + options.names.front());
    if (options.action == "remove") {
      objects.erase(found);
    } else {
      require_object_name(options.names[1]);
      if (named(options.names[1]) != objects.end())
        throw Error(options.map + ": another object has the name " + options.names[1]);
      found->name = options.names[1];
    }
    write_kept_objects(folder, objects);
    delete_unused_models(folder);
  }
  for (const KeptObject& object : objects) {  // as lines of a script
    const StandObject stand{object.name, object.T_world_object.translation(),
                            Eigen::Quaterniond(object.T_world_object.linear())};
    std::printf("%s\n", to_line({.action = stand, .frame = 0}).c_str());
  }
  if (objects.empty()) std::printf("%s: no objects stay in it\n", options.map.c_str());
  return 0;
}

}  // namespace roomradar
