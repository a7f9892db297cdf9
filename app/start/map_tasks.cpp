// map_tasks.cpp: each task checks first, and changes nothing if a check fails.
#include "app/start/map_tasks.hpp"

#include <cstdio>

#include "app/cli/registered_maps.hpp"
#include "app/page/room_page.hpp"
#include "app/start/map_list.hpp"
#include "mapping/map/map_export.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/storage/atomic_folder.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

bool is_taken(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored)) ||
         fs::exists(fs::symlink_status(unfinished_scan_of(path), ignored));
}

/// Returns the path, or the first of PATH-2, PATH-3, ... that is not taken.
fs::path free_path(const fs::path& stem, const std::string& extension) {
  fs::path path = stem.string() + extension;
  for (int n = 2; is_taken(path); ++n) path = stem.string() + "-" + std::to_string(n) + extension;
  return path;
}

void move_folder(const fs::path& from, const fs::path& to) {
  std::error_code fault;
  fs::rename(from, to, fault);
  if (fault)
    throw Error(from.string() + ": cannot be renamed to " + to.string() + ": " + system_reason(fault));
}

std::string sentence_of(const Change& change) {
  const Eigen::Vector3d &at = change.position_world, size = change.box_world.sizes();
  char text[200];
  format_classic(text, sizeof text,
                 "%s: %.0f \u00D7 %.0f \u00D7 %.0f cm, %.1f litres, at x %.2f, y %.2f, z %.2f m",
                 change.kind == ChangeKind::kAppeared ? "Appeared" : "Vanished", 100.0 * size.x(),
                 100.0 * size.y(), 100.0 * size.z(), 1e3 * change.volume_m3, at.x(), at.y(), at.z());
  return text;
}

}  // namespace

std::string proposed_map_name(const fs::path& folder, std::time_t now) {
  std::tm local{};
  char date[20] = "";
  if (localtime_r(&now, &local) != nullptr) std::strftime(date, sizeof date, "-%Y-%m-%d", &local);
  const fs::path taken_at = free_path(folder / "maps" / (std::string("room") + date), "");
  return (fs::path("maps") / taken_at.filename()).string();
}

fs::path rename_map(const fs::path& map, const std::string& new_name) {
  if (new_name.empty() || new_name.find('/') != std::string::npos || new_name == "." || new_name == "..")
    throw Error("'" + new_name + "': is not a valid map name; give one without a slash, such as kitchen");
  std::error_code ignored;
  if (fs::exists(unfinished_scan_of(map), ignored))
    throw Error(map.string() +
                ": an interrupted scan belongs to this name; continue it first (Scan more), then rename");
  load_map_info(map);
  const fs::path renamed = map.parent_path() / new_name;
  if (renamed == map) return map;
  if (is_taken(renamed)) throw Error(renamed.string() + ": already exists; choose another name");
  move_folder(map, renamed);
  return renamed;
}

void delete_map(const fs::path& map) {
  const fs::path unfinished = unfinished_scan_of(map);
  std::error_code ignored;
  const bool has_unfinished = fs::is_regular_file(unfinished / "work.json", ignored);
  const bool is_saved = fs::exists(map / kMapInfoFile, ignored);
  if (!has_unfinished && !is_saved) throw Error(map.string() + ": there is no such map");
  if (is_saved) {
    if (fs::is_symlink(map, ignored))
      throw Error(map.string() + ": is a link to a map; delete the map itself, or the link by hand");
    require_replaceable(map);
    remove_whole_folder(map);
  }
  if (has_unfinished) remove_whole_folder(unfinished);
}

fs::path export_beside(const fs::path& map, const std::string& extension) {
  const fs::path path = free_path(tidy_map_name(map), extension);
  if (is_page(path))
    write_map_page(load_map(map), map, path);
  else
    export_map(map, path);
  return path;
}

std::vector<std::string> compare_maps(const fs::path& a, const fs::path& b) {
  const SavedMap earlier = load_map(a), later = load_map(b);
  Report report;
  const MapChanges found = changes_between(earlier, later, a.string(), b.string(), report);
  std::vector<std::string> sentences;
  for (const Change& change : found.changes) sentences.push_back(sentence_of(change));
  if (sentences.empty()) sentences.emplace_back("Nothing appeared, nothing vanished.");
  return sentences;
}

}  // namespace roomradar
