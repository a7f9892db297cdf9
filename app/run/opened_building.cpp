// opened_building.cpp: reads the keyframes and the list of tiles; tiles are read during the run.
#include "app/run/opened_building.hpp"

#include <algorithm>
#include <utility>

#include "mapping/building/building_map.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/process_memory.hpp"

namespace roomradar {
namespace {

constexpr double kMB = 1e6;
constexpr double kKeyframesPart = 0.2;  // of the memory limit

void require_possible_in_building(const RunOptions& options, const Script& script) {
  const auto refuse = [&](const std::string& option, const char* why) {
    throw Error(option + ": " + options.map + " is a building, and " + why);
  };
  constexpr const char* kRoomsOnly = "changes can be committed to the map of a room only";
  if (options.commit_after_s) refuse("--commit-changes", kRoomsOnly);
  if (!options.save_map.empty()) refuse("--save-map", kRoomsOnly);
  if (has<CommitChanges>(script)) refuse("commit event", kRoomsOnly);
  if (options.poses == PoseOrigin::kRecorded)
    refuse("--poses recorded", "its world is not that of a recording; leave the option out");
}

}  // namespace

OpenedBuilding open_building(const RunOptions& options, const Script& script) {
  require_possible_in_building(options, script);
  OpenedBuilding opened;
  opened.tiles.folder = options.map;
  opened.tiles.building = read_building(options.map);
  opened.tiles.choice.has_unknown = options.unknown_is_solid;
  opened.tiles.max_process_bytes = static_cast<std::size_t>(kMB * options.max_memory_mb);
  const BuildingInfo& building = opened.tiles.building;
  if (building.tiles.empty()) throw Error(options.map + ": has no tiles; was any recording placed?");
  if (options.unknown_is_solid &&
      std::any_of(building.tiles.begin(), building.tiles.end(),
                  [](const BuildingTile& tile) { return tile.unknown.name.empty(); }))
    throw Error(
        options.map +
        ": has no frontier of unknown space, since an earlier version made it; run `roomradar building` "
        "again with the same recordings, or add --unknown free");
  mmap_large_allocations();  // tiles come and go: their memory goes back to the system

  const double keyframes_mb = kKeyframesPart * options.max_memory_mb;
  opened.map.keyframe_database =
      load_building_keyframes(building, options.map, static_cast<std::size_t>(kMB * keyframes_mb));
  release_unused_memory();
  MapInfo& info = opened.map.info;
  info.source = options.map;
  info.up_source = "building";
  info.resolution_m = building.grid.resolution_m;
  info.keyframes = opened.map.keyframe_database.load().keyframes.size();
  for (const BuildingTile& tile : building.tiles) {
    info.triangles += static_cast<std::uint64_t>(std::max<std::int64_t>(tile.triangles, 0));
    info.counts.known_world.extend(tile.surface_world);
  }
  return opened;
}

}  // namespace roomradar
