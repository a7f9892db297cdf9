// map_list.cpp: finds maps and describes them.
#include "app/start/map_list.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string_view>

#include "app/media/map_picture.hpp"
#include "app/start/subfolders.hpp"
#include "mapping/coverage/coverage.hpp"
#include "mapping/map/level_surfaces.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUnfinished = ".unfinished";

std::string text_of(const char* form, auto... values) {
  char text[200];
  format_classic(text, sizeof text, form, values...);
  return text;
}

std::time_t saved_at(const fs::path& file) {
  std::error_code fault;
  const fs::file_time_type at = fs::last_write_time(file, fault);
  if (fault) return 0;
  return std::chrono::system_clock::to_time_t(
      std::chrono::time_point_cast<std::chrono::system_clock::duration>(std::chrono::file_clock::to_sys(at)));
}

std::string date_text(std::time_t at) {
  std::tm local{};
  char text[40];
  if (localtime_r(&at, &local) == nullptr || std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local) == 0)
    return "unknown";
  return text;
}

void add_maps_in(const fs::path& folder, std::vector<MapEntry>& maps) {
  for (fs::path map : subfolders(folder)) {
    std::error_code ignored;
    if (map.extension() == kUnfinished) {
      map.replace_extension();
      if (fs::exists(map / kMapInfoFile, ignored)) continue;  // listed as a map
    }
    if (is_map(map)) maps.push_back(describe_map(map));
  }
}

void count_holes(const SavedMap& map, MapDetails& details) {
  for (const Hole& hole : survey_coverage(map.octree.load(), map.mesh, map.trajectory).holes) {
    if (!is_inside_scan(hole)) {
      ++details.outer_holes;
      continue;
    }
    ++details.holes;
    details.largest_hole_m2 = std::max(details.largest_hole_m2, hole.area_m2);
  }
}

std::string holes_text(const MapDetails& details) {
  const std::size_t all = details.holes + details.outer_holes;
  if (all == 0) return "none";
  std::string text = std::to_string(all) + ", " + std::to_string(details.holes) + " inside the scan";
  if (details.largest_hole_m2 >= 0.01) text += text_of(", the largest %.2f m\u00B2", details.largest_hole_m2);
  return text;
}

/// Returns a text of the first source and the number of the others.
std::string sources_text(const std::string& sources) {
  constexpr std::string_view kBetween = "; ";
  std::size_t others = 0;
  for (std::size_t at = sources.find(kBetween); at != std::string::npos; at = sources.find(kBetween, at + 1))
    ++others;
  if (others == 0) return sources;
  return sources.substr(0, sources.find(kBetween)) + " and " + std::to_string(others) + " more";
}

}  // namespace

fs::path unfinished_scan_of(const fs::path& map) { return map.string() + kUnfinished; }

bool is_map(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / kMapInfoFile, ignored) ||
         fs::is_regular_file(unfinished_scan_of(folder) / "work.json", ignored);
}

MapEntry describe_map(const fs::path& folder) {
  MapEntry map;
  map.folder = folder;
  std::error_code ignored;
  map.has_unfinished_scan = fs::is_regular_file(unfinished_scan_of(folder) / "work.json", ignored);
  map.is_saved = fs::exists(folder / kMapInfoFile, ignored);
  map.saved_at = saved_at(map.is_saved ? folder / kMapInfoFile : unfinished_scan_of(folder));
  if (!map.is_saved) {
    map.fault =
        map.has_unfinished_scan
            ? folder.string() + ": its scan was interrupted; Scan more (M) continues it, with the same source"
            : folder.string() + ": there is no such map";
    return map;
  }
  try {
    const MapInfo info = load_map_info(folder);
    for (const auto& [name, file] : info.files) map.bytes += file.bytes;
    if (!info.counts.occupied_world.isEmpty()) map.size_m = info.counts.occupied_world.sizes();
    map.source = info.source;
  } catch (const std::exception& error) {
    map.fault = error.what();
  }
  return map;
}

std::vector<MapEntry> list_maps(const fs::path& folder) {
  std::vector<MapEntry> maps;
  std::error_code ignored;
  if (fs::exists(folder / kMapInfoFile, ignored)) maps.push_back(describe_map(folder));
  add_maps_in(folder / "maps", maps);
  add_maps_in(folder, maps);
  std::stable_sort(maps.begin(), maps.end(), [](const MapEntry& a, const MapEntry& b) {
    return a.saved_at != b.saved_at ? a.saved_at > b.saved_at : a.folder < b.folder;
  });
  return maps;
}

MapDetails examine_map(const fs::path& folder, int width_px, Rgb ground) {
  MapDetails details;
  try {
    const SavedMap map = load_map(folder);
    details.picture = draw_changes(map.mesh, {}, width_px, ground);
    details.surface_m2 = surface_area_m2(map.mesh);
    const std::vector<LevelSurface> surfaces = level_surfaces(map.mesh);
    const std::vector<bool> is_floor = floor_among(surfaces, map.mesh);
    for (std::size_t i = 0; i < surfaces.size(); ++i)
      if (is_floor[i]) details.floor_m2 = details.floor_m2.value_or(0.0) + surfaces[i].area_m2;
    count_holes(map, details);
  } catch (const std::exception& error) {
    details.fault = error.what();
  }
  return details;
}

std::vector<std::pair<std::string, std::string>> facts_of(const MapEntry& map, const MapDetails* details) {
  std::vector<std::pair<std::string, std::string>> facts;
  facts.emplace_back(map.is_saved ? "saved" : "begun", date_text(map.saved_at));
  if (!map.fault.empty()) return facts;
  facts.emplace_back(
      "room", text_of("%.1f \u00D7 %.1f \u00D7 %.1f m", map.size_m.x(), map.size_m.y(), map.size_m.z()));
  if (details != nullptr && details->fault.empty()) {
    facts.emplace_back("surface", text_of("%.1f m\u00B2", details->surface_m2));
    facts.emplace_back("floor",
                       details->floor_m2 ? text_of("%.1f m\u00B2", *details->floor_m2) : "not found");
    facts.emplace_back("holes", holes_text(*details));
  } else if (details == nullptr) {
    facts.emplace_back("surface", "being measured");
  }
  facts.emplace_back("disk", text_of("%.1f MB", static_cast<double>(map.bytes) / 1e6));
  facts.emplace_back("from", sources_text(map.source));
  if (map.has_unfinished_scan) facts.emplace_back("scan", "interrupted; Scan more (M) continues it");
  return facts;
}

}  // namespace roomradar
