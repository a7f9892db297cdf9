// mapped_room.cpp: fuses a simulated camera trajectory through each room, several rooms concurrently.
#include "app/evaluation/fallthrough/mapped_room.hpp"

#include <deque>
#include <filesystem>
#include <future>
#include <mutex>

#include "app/cli/progress.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/types/pose_origin.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

SimOptions walk_of(const ScenarioRoom& room, const RoomScan& scan) {
  SimOptions walk = room.prescan;
  walk.frames = (walk.frames + scan.every - 1) / scan.every;
  walk.rate_hz /= scan.every;
  walk.with_colour = false;
  walk.depth_camera = kinect_of_width(scan.width_px);
  return walk;
}

/// Returns true if the folder holds this walk's map, made by this version. Throws Error if it holds another
/// source's map, which must not be overwritten.
bool is_scan_of(const std::filesystem::path& folder, const SimOptions& walk, const RoomScan& scan) {
  if (!std::filesystem::exists(folder)) return false;
  const MapInfo info = load_map_info(folder);
  if (info.source != sim_spec(walk))
    throw Error(folder.string() + ": is the map of " + info.source +
                ", but the map of a simulated room would be stored there; name another folder with --maps");
  return info.frames_fused == walk.frames && info.resolution_m == scan.resolution_m &&
         info.tool_version == kVersion;
}

void fuse_walk(const SimOptions& walk, const RoomScan& scan, const std::function<void()>& progress,
               SavedMap& map) {
  SimulatedSource source(walk);
  map.octree = StaticMap(scan.resolution_m);
  map.info.source = sim_spec(walk);
  map.info.settings[kPosesSetting] = to_string(PoseOrigin::kRecorded);
  Frame frame;
  while (source.next(frame).status == ReadStatus::kFrame) {
    ++map.info.frames_read;
    if (map.octree.load().fuse(frame, *frame.T_world_camera) == FuseStatus::kFused) ++map.info.frames_fused;
    progress();
  }
  map.mesh = extract_surface(map.octree.load());
}

}  // namespace

std::vector<RoomChoice> choose_rooms(int random_rooms) {
  std::vector<RoomChoice> rooms;
  for (const std::string& name : room_names()) rooms.push_back({name, 1});
  for (int i = 1; i <= random_rooms; ++i)
    rooms.push_back({std::string(kRandomRoom), static_cast<std::uint64_t>(i)});
  return rooms;
}

ScannedRoom scan_room(const RoomChoice& choice, const RoomScan& scan, const std::function<void()>& progress) {
  ScannedRoom room;
  room.title = choice.name == kRandomRoom ? choice.name + " " + std::to_string(choice.seed) : choice.name;
  room.simulated = make_scenario_room(choice.name, choice.seed);
  const SimOptions walk = walk_of(room.simulated, scan);
  const std::filesystem::path folder =
      scan.maps.empty()
          ? std::filesystem::path()
          : std::filesystem::path(scan.maps) / (choice.name + "-" + std::to_string(choice.seed));
  SavedMap map;
  if (!folder.empty() && is_scan_of(folder, walk, scan)) {
    map = load_map(folder);
    for (std::int64_t i = 0; i < walk.frames; ++i) progress();
  } else {
    fuse_walk(walk, scan, progress, map);
    if (map.mesh.triangles.empty())
      throw Error("room " + room.title + ": the walk round it shows no surface; use a finer resolution");
    if (!folder.empty()) save_map(folder, map);
  }
  const std::shared_ptr<const UnknownSurface>& stored = map.unknown.load();
  room.unknown_world = stored ? stored->mesh_world : unknown_surface(map.octree.load(), map.mesh).mesh_world;
  room.mesh_world = std::move(map.mesh);
  return room;
}

MappedRoom::MappedRoom(GlContext& context, ScannedRoom room) : scanned(std::move(room)), shape(context) {
  shape.set(scanned.mesh_world, MeshUsage::kStatic);
  unknown.build_by_place(scanned.unknown_world);
  for (const FallthroughPolicy& policy : kFallthroughPolicies)
    scenes.push_back(std::make_unique<FrameScene>(context, shape,
                                                  FrameSceneConfig{.surfaces = policy.surfaces},
                                                  policy.unknown_solid ? &unknown : nullptr));
}

std::vector<std::unique_ptr<MappedRoom>> map_rooms(GlContext& context, const std::vector<RoomChoice>& rooms,
                                                   const RoomScan& scan, int threads) {
  const std::int64_t frames_each = (kScenarioPrescanFrames + scan.every - 1) / scan.every;
  Progress progress("prescan of " + std::to_string(rooms.size()) + " rooms",
                    static_cast<std::int64_t>(rooms.size()) * frames_each);
  std::mutex mutex;
  const auto step = [&] {
    const std::lock_guard lock(mutex);
    progress.step();
  };
  std::deque<std::future<ScannedRoom>> under_way;
  std::vector<std::unique_ptr<MappedRoom>> mapped;
  for (std::size_t next = 0; mapped.size() < rooms.size();) {
    while (next < rooms.size() && under_way.size() < static_cast<std::size_t>(threads)) {
      under_way.push_back(
          std::async(std::launch::async, [&, next] { return scan_room(rooms[next], scan, step); }));
      ++next;
    }
    ScannedRoom scanned = under_way.front().get();
    under_way.pop_front();
    mapped.push_back(std::make_unique<MappedRoom>(context, std::move(scanned)));
  }
  return mapped;
}

}  // namespace roomradar
