// building_summary.cpp: one pass over the tiles' meshes.
#include "app/building/building_summary.hpp"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json array_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

template <typename... Values>
std::string text_line(const char* format, Values... values) {
  std::array<char, 200> text{};
  format_classic(text.data(), text.size(), format, values...);
  return text.data();
}

}  // namespace

BuildingSummary summarise_building(const fs::path& folder) {
  BuildingSummary summary;
  summary.info = read_building(folder);
  std::vector<LevelSurface> surfaces;
  for (const BuildingTile& tile : summary.info.tiles) {
    const Mesh mesh = read_tile_mesh(folder / tile.mesh.name);
    const std::vector<LevelSurface> own = level_surfaces(mesh);
    surfaces.insert(surfaces.end(), own.begin(), own.end());
    summary.surface_m2 += surface_area_m2(mesh);
    summary.triangles += tile.triangles;
    for (const ContentFile* file : files_of(tile)) summary.bytes += file->bytes;
    summary.surface_world.extend(tile.surface_world);
  }
  for (const BuildingRecording& recording : summary.info.recordings)
    summary.bytes += recording.keyframe_file.bytes;
  summary.floors = floors_among(surfaces);
  return summary;
}

std::string describe(const BuildingSummary& summary) {
  std::string text;
  const char* name = "recordings";
  for (const BuildingRecording& one : summary.info.recordings) {
    text += text_line("%-16s%s, %lld of %lld frames tracked, %lld keyframes%s\n", name,
                      one.name.substr(0, 60).c_str(), static_cast<long long>(one.frames_tracked),
                      static_cast<long long>(one.frames_read), static_cast<long long>(one.keyframes),
                      one.frames_placed == 0                   ? ", not placed"
                      : one.frames_placed < one.frames_tracked ? ", placed in part"
                                                               : "");
    name = "";
  }
  text += text_line("%-16s%g m\n", "resolution", summary.info.grid.resolution_m);
  text += text_line("%-16s%zu with an edge of %g m\n", "tiles", summary.info.tiles.size(),
                    edge_m(summary.info.grid));
  text += text_line("%-16s%.1f MB\n", "size", 1e-6 * static_cast<double>(summary.bytes));
  text += text_line("%-16s%lld triangles, %.1f m2\n", "surface", static_cast<long long>(summary.triangles),
                    summary.surface_m2);
  if (!summary.surface_world.isEmpty()) {
    const Eigen::Vector3d low = rounded(summary.surface_world.min(), 2),
                          high = rounded(summary.surface_world.max(), 2);
    text += text_line("%-16sx %.2f..%.2f, y %.2f..%.2f, z %.2f..%.2f m\n", "extents", low.x(), high.x(),
                      low.y(), high.y(), low.z(), high.z());
  }
  name = "floors";
  for (const BuildingFloor& floor : summary.floors) {
    text += text_line("%-16sz %.2f m, %.1f m2\n", name, rounded(floor.height_m, 2), floor.area_m2);
    name = "";
  }
  if (summary.floors.empty()) text += "floors          none\n";
  return text;
}

json json_of(const BuildingSummary& summary) {
  json value = {{"kind", "building"},
                {"resolution_m", summary.info.grid.resolution_m},
                {"tile_edge_m", edge_m(summary.info.grid)},
                {"triangles", summary.triangles},
                {"bytes", summary.bytes},
                {"surface_m2", summary.surface_m2},
                {"recordings", json::array()},
                {"tiles", json::array()},
                {"floors", json::array()}};
  if (!summary.surface_world.isEmpty())
    value["extents_m"] = {{"min", array_of(summary.surface_world.min())},
                          {"max", array_of(summary.surface_world.max())}};
  for (const BuildingRecording& one : summary.info.recordings)
    value["recordings"].push_back({{"name", one.name},
                                   {"frames_read", one.frames_read},
                                   {"frames_tracked", one.frames_tracked},
                                   {"keyframes", one.keyframes},
                                   {"frames_placed", one.frames_placed}});
  for (const BuildingTile& tile : summary.info.tiles) {
    value["tiles"].push_back({{"name", name_of(tile.index)},
                              {"triangles", tile.triangles},
                              {"surface_min_m", array_of(tile.surface_world.min())},
                              {"surface_max_m", array_of(tile.surface_world.max())},
                              {"octree", tile.octree.name},
                              {"mesh", tile.mesh.name},
                              {"glb", tile.glb.name}});
    if (!tile.unknown.name.empty()) value["tiles"].back()["unknown"] = tile.unknown.name;
  }
  for (const BuildingFloor& floor : summary.floors)
    value["floors"].push_back({{"height_m", floor.height_m}, {"area_m2", floor.area_m2}});
  return value;
}

}  // namespace roomradar
