// map_files.cpp: checks of names and folders, before anything is written.
#include "mapping/map/map_files.hpp"

#include <algorithm>
#include <system_error>

#include "mapping/history/visits.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

}  // namespace

bool is_map_part(const std::string& name) {
  return name == kMapCoverageFile || name == kMapUnknownFile || name == kMapTextureFile ||
         name == kMapTexturePointsFile || name == kMapOldOctreeFile || name == kMapOldPlainOctreeFile ||
         std::find(kMapParts.begin(), kMapParts.end(), name) != kMapParts.end();
}

bool is_map_entry(const std::string& name) {
  return name == kMapInfoFile || name == kMapObjectsFolder || is_map_part(name) || name.starts_with("visits");
}

void require_replaceable(const fs::path& folder) {
  require_outside_maps(folder);
  std::error_code fault;
  const fs::file_status status = fs::symlink_status(folder, fault);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status))
    refuse(folder, "exists and is not a folder; choose another name for the map");
  if (fs::exists(folder / "building.json", fault))
    refuse(folder,
           "is the map of a building; a room's map takes its own folder, so choose another name for the map");
  bool empty = true;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    const std::string name = entry.path().filename().string();
    if (is_litter(name)) continue;
    empty = false;
    if (!is_map_entry(name))
      refuse(folder, "exists and holds \"" + name +
                         "\", which is not part of a map; choose another name for the map");
  }
  if (fault) refuse(folder, "cannot be listed: " + system_reason(fault));
  if (!empty && !fs::exists(folder / kMapInfoFile))
    refuse(folder, std::string("exists and has no ") + kMapInfoFile +
                       ", so it is not a map; choose another name for the map");
}

fs::path tidy_map_name(const fs::path& folder) {
  if (folder.empty()) throw Error("the map's folder has no name; give one, such as maps/kitchen");
  fs::path path = folder.lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // a trailing slash
  if (path.filename() == "." || path.filename() == ".." || !path.has_filename())
    refuse(folder, "is not a valid name for a map's folder; give a new one, such as maps/kitchen");
  return path;
}

void require_outside_maps(const fs::path& path) {
  if (path.empty()) return;
  std::error_code ignored;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (fs::exists(folder / kMapInfoFile, ignored))
    refuse(path, "lies in the folder of a map, which may contain only the map; choose another place");
}

void require_contents_outside_maps(const fs::path& folder) {
  if (folder.empty()) return;
  require_outside_maps((folder / "").parent_path());
  require_outside_maps(folder / "contents");
}

void require_can_become_map(const fs::path& folder, std::initializer_list<fs::path> outputs) {
  const fs::path map = tidy_map_name(folder);
  require_replaceable(map);
  static_cast<void>(read_visits(map));  // throws if the log of its revisions is damaged
  std::error_code ignored;              // paths that cannot be resolved are rejected when they are written
  const fs::path whole = fs::weakly_canonical(fs::absolute(map), ignored);
  for (const fs::path& output : outputs) {
    if (output.empty()) continue;
    const fs::path path = fs::weakly_canonical(fs::absolute(output), ignored);
    if (!whole.empty() &&
        std::mismatch(whole.begin(), whole.end(), path.begin(), path.end()).first == whole.end())
      refuse(output, "would lie in " + map.string() +
                         ", which is to be a map and may contain only the map; choose another place");
  }
}

}  // namespace roomradar
