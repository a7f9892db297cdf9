// map_housekeeping_command.cpp: roomradar map list|copy|rename|delete|pack|unpack: maps as folders and files.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "app/cli/shell_line.hpp"
#include "app/commands/commands.hpp"
#include "app/objects/kept_objects.hpp"
#include "app/start/map_list.hpp"
#include "mapping/building/building_info.hpp"
#include "mapping/map/map_files.hpp"
#include "mapping/map/map_package.hpp"
#include "mapping/map/map_places.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// A line of `map list`.
struct ListedMap {
  MapPlace place;
  std::size_t objects = 0;  ///< objects that stay in the room
};

/// Adds what the map's folder alone does not tell: objects of a room, tiles of a building.
ListedMap listed(MapPlace place) {
  ListedMap map{.place = std::move(place)};
  MapPlace& found = map.place;
  try {
    if (!found.is_building) {
      map.objects = read_kept_objects(found.folder / kMapObjectsFolder).size();
    } else {
      const BuildingInfo building = read_building(found.folder);
      for (const BuildingTile& tile : building.tiles)
        found.triangles += static_cast<std::uint64_t>(tile.triangles);
      const std::size_t recordings = building.recordings.size();
      found.source =
          "building of " + std::to_string(recordings) + (recordings == 1 ? " recording" : " recordings");
    }
  } catch (const std::exception& error) {
    if (found.fault.empty()) found.fault = error.what();
  }
  return map;
}

std::string time_text(std::time_t at, const char* form, bool is_utc) {
  std::tm parts{};
  char text[40];
  if (at == 0 || (is_utc ? gmtime_r(&at, &parts) : localtime_r(&at, &parts)) == nullptr ||
      std::strftime(text, sizeof text, form, &parts) == 0)
    return {};
  return text;
}

/// Returns the text with '?' for control characters, which would change the terminal.
std::string shown(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }, '?');
  return text;
}

std::string megabytes(std::uintmax_t bytes) { return format_fixed(static_cast<double>(bytes) / 1e6, 1); }

std::uintmax_t bytes_of_map(const fs::path& folder) {
  std::uintmax_t bytes = 0;
  for (const MapContent& content : contents_of_map(folder)) bytes += content.bytes;
  return bytes;
}

nlohmann::json json_of(const ListedMap& map) {
  const MapPlace& place = map.place;
  const bool is_sound = place.fault.empty();
  const std::string saved = time_text(place.saved_at, "%Y-%m-%dT%H:%M:%SZ", /*is_utc=*/true);
  nlohmann::json json = {{"name", place.folder.filename().string()},
                         {"path", place.folder.string()},
                         {"kind", place.is_building ? "building" : "room"},
                         {"bytes", place.bytes},
                         {"triangles", nullptr},
                         {"objects", nullptr},
                         {"saved", nullptr},
                         {"source", place.source},
                         {"fault", nullptr}};
  if (!saved.empty()) json["saved"] = saved;
  if (is_sound) json["triangles"] = place.triangles;
  if (is_sound && !place.is_building) json["objects"] = map.objects;
  if (!is_sound) json["fault"] = place.fault;
  return json;
}

void print_table(const std::vector<ListedMap>& maps) {
  std::size_t width = 4;
  for (const ListedMap& map : maps) width = std::max(width, map.place.folder.filename().string().size());
  const auto print = [width](const std::string& name, const std::string& size, const std::string& triangles,
                             const std::string& objects, const std::string& saved,
                             const std::string& source) {
    std::printf("%-*s  %9s  %9s  %7s  %-16s  %s\n", static_cast<int>(width), name.c_str(), size.c_str(),
                triangles.c_str(), objects.c_str(), saved.c_str(), source.c_str());
  };
  print("map", "MB", "triangles", "objects", "saved", "source");
  for (const ListedMap& map : maps) {
    const MapPlace& place = map.place;
    const bool is_sound = place.fault.empty();
    const std::string saved = time_text(place.saved_at, "%Y-%m-%d %H:%M", /*is_utc=*/false);
    print(shown(place.folder.filename().string()), megabytes(place.bytes),
          is_sound ? std::to_string(place.triangles) : "-",
          is_sound && !place.is_building ? std::to_string(map.objects) : "-",
          saved.empty() ? "not known" : saved,
          is_sound            ? shown(place.source)
          : place.is_building ? "building, damaged: see below"
                              : "damaged: see below");
  }
}

std::string unfinished_beside(const fs::path& map) {
  const fs::path unfinished = unfinished_scan_of(map);
  std::error_code ignored;
  return fs::exists(unfinished, ignored) ? unfinished.string() : std::string();
}

}  // namespace

int run(const MapListOptions& options) {
  std::error_code ignored;
  const bool is_default = options.folder == MapListOptions{}.folder;
  std::vector<ListedMap> maps;
  if (!is_default || fs::exists(options.folder, ignored))
    for (MapPlace& place : map_places_in(options.folder)) maps.push_back(listed(std::move(place)));
  if (options.json) {
    nlohmann::json rows = nlohmann::json::array();
    for (const ListedMap& map : maps) rows.push_back(json_of(map));
    const nlohmann::json json = {{"folder", options.folder}, {"maps", rows}};
    std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else if (maps.empty()) {
    std::printf("%s: there are no maps in it; `roomradar prescan SOURCE --map %s` makes one\n",
                options.folder.c_str(), (fs::path(options.folder) / "NAME").c_str());
  } else {
    print_table(maps);
  }
  std::fflush(stdout);  // the faults come after the table
  bool is_damaged = false;
  for (const ListedMap& map : maps) {
    if (map.place.fault.empty()) continue;
    is_damaged = true;
    std::fprintf(stderr, "roomradar: %s\n", shown(map.place.fault).c_str());
  }
  return is_damaged ? 1 : 0;
}

int run(const MapCopyOptions& options) {
  copy_map(options.map, options.to);
  std::printf("%s: a copy of %s, %s MB\n", options.to.c_str(), options.map.c_str(),
              megabytes(bytes_of_map(options.to)).c_str());
  return 0;
}

int run(const MapRenameOptions& options) {
  if (const std::string unfinished = unfinished_beside(existing_map(options.map)); !unfinished.empty())
    throw Error(options.map + ": an interrupted scan belongs to this name (" + unfinished +
                "); complete it with `roomradar prescan --resume`, or delete that folder, then rename");
  move_map(options.map, options.to);
  std::printf("%s: is now %s\n", options.map.c_str(), options.to.c_str());
  return 0;
}

int run(const MapDeleteOptions& options) {
  const std::string unfinished = unfinished_beside(existing_map(options.map));
  if (options.for_good) {
    erase_map(options.map);
    std::printf("%s: deleted for good\n", options.map.c_str());
  } else {
    const fs::path place = move_map_to_trash(options.map);
    std::printf("%s: is now in the trash, %s\n`%s` brings it back\n", options.map.c_str(), place.c_str(),
                shell_line({"roomradar", "map", "rename", place.string(), options.map}).c_str());
  }
  if (!unfinished.empty())
    std::printf("%s: an interrupted scan of that name, stays where it is\n", unfinished.c_str());
  return 0;
}

int run(const MapPackOptions& options) {
  pack_map(options.map, options.file);
  std::printf("%s: %s MB, of %s MB in %s\n", options.file.c_str(),
              megabytes(fs::file_size(options.file)).c_str(), megabytes(bytes_of_map(options.map)).c_str(),
              options.map.c_str());
  return 0;
}

int run(const MapUnpackOptions& options) {
  const fs::path map = unpack_map(options.file, options.map);
  std::printf("%s: unpacked from %s, %s MB\n", map.c_str(), options.file.c_str(),
              megabytes(bytes_of_map(map)).c_str());
  return 0;
}

}  // namespace roomradar
