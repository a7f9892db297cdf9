// simulate.cpp: passes frames to the recording writer, and writes ground truth to separate files.
#include "app/sim/simulate.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/sim/building/building_walk.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "app/sim/room/room_parts.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sources/formats/image_file.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {
namespace {

/// Describes the plan of the building, and the walk.
nlohmann::ordered_json plan_json(const SimOptions& options) {
  const BuildingPlan plan = plan_building(options.seed, options.building);
  nlohmann::ordered_json json;
  json["floors"] = plan.size.floors;
  json["storey_height_m"] = kStoreyHeight_m;
  json["walk"] = options.walk;
  if (options.walk == kRingWalk) json["walk"] = "ring";
  json["walk_rooms"] = rooms_of_walk(plan, options.walk);
  json["rooms"] = nlohmann::json::array();
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    const PlannedRoom& room = plan.rooms[i];
    const Eigen::Vector2d low = room.middle_m - room.half_m, high = room.middle_m + room.half_m;
    nlohmann::ordered_json one{{"number", i}, {"floor", room.floor}};
    one["min_m"] = {low.x(), low.y(), floor_height_m(room.floor)};
    one["max_m"] = {high.x(), high.y(), floor_height_m(room.floor) + kStoreyHeight_m};
    if (room.twin >= 0) one["looks_like"] = room.twin;
    json["rooms"].push_back(one);
  }
  return json;
}

std::string description(const SimOptions& options) {
  nlohmann::ordered_json json;
  json["format"] = "roomradar simulation";
  json["version"] = 1;
  json["source"] = sim_spec(options);
  json["room"] = options.room;
  json["seed"] = options.seed;
  json["frames"] = options.frames;
  json["rate_hz"] = options.rate_hz;
  json["path"] = to_string(options.path);
  json["movers"] = nlohmann::json::array();
  for (const MoverKind kind : options.movers) json["movers"].push_back(to_string(kind));
  json["crate"] = to_string(options.crate);
  if (options.moved > 0.0) json["moved"] = options.moved;
  json["noise_scale"] = options.noise_scale;
  const Intrinsics& camera = options.depth_camera;
  json["depth_camera"] = {{"width_px", camera.width_px}, {"height_px", camera.height_px},
                          {"fx_px", camera.fx_px},       {"fy_px", camera.fy_px},
                          {"cx_px", camera.cx_px},       {"cy_px", camera.cy_px}};
  json["registered_colour"] = options.registered_colour;
  if (options.room == kBuildingRoom) json["building"] = plan_json(options);
  return json.dump(2) + "\n";
}

/// Returns the mesh of the parts of a building that were seen.
Mesh mesh_of_parts(const Room& room, const std::vector<char>& is_seen) {
  Mesh mesh;
  for (std::size_t part = 0; part < room.parts.size(); ++part)
    for (std::size_t i = room.parts[part].solids_begin; is_seen[part] != 0 && i < room.parts[part].solids_end;
         ++i)
      append_mesh(room.solids[i], room.materials[i].first, kMeshDeviation_m, mesh);
  return mesh;
}

}  // namespace

void simulate(const std::filesystem::path& folder, const SimOptions& options, RecordingFormat format,
              const std::function<void(std::int64_t, std::int64_t)>& progress) {
  SimulatedSource source(options);
  RecordingWriter writer(folder, format);
  const std::filesystem::path truth = folder / "truth";
  const bool moves =
      !options.movers.empty() || options.crate == CrateKind::kComes || options.crate == CrateKind::kGoes;
  make_folder(truth / "depth");
  for (const char* const masks : {"moved", "mover", "revealed"})
    if (moves) make_folder(truth / masks);
  SimOptions written = options;
  written.frames = source.frame_count().value();
  write_bytes(truth / "sim.json", description(written));
  const Room& room = source.room();
  if (room.parts.empty()) write_mesh(room_mesh(room), truth / "room.ply");

  std::vector<char> is_seen(room.parts.size(), 0);
  std::vector<TimedPose> trajectory;
  Frame frame;
  while (source.next(frame).status == ReadStatus::kFrame) {
    writer.write(frame);
    const std::string name = format_frame_number(frame.index) + ".png";
    write_depth_file(source.truth().depth_m, DepthEncoding::kTum, truth / "depth" / name);
    if (moves) {
      write_mask_file(source.truth().moved, truth / "moved" / name);
      write_mask_file(source.truth().mover, truth / "mover" / name);
      write_mask_file(source.truth().revealed, truth / "revealed" / name);
    }
    trajectory.push_back({frame.index, frame.stamp_s, source.truth().T_world_camera});
    if (!room.parts.empty())
      for (const int part : visible_parts(room, source.truth().T_world_camera.translation()))
        is_seen[static_cast<std::size_t>(part)] = 1;
    if (progress) progress(frame.index + 1, written.frames);
  }
  writer.close();
  if (!room.parts.empty()) write_mesh(mesh_of_parts(room, is_seen), truth / "room.ply");
  write_trajectory(truth / "trajectory.txt", trajectory);
}

void simulate_walks(const std::filesystem::path& folder, const SimOptions& options, std::int64_t first,
                    std::int64_t last, RecordingFormat format,
                    const std::function<void(const std::string&, std::int64_t, std::int64_t)>& progress) {
  if (options.room != kBuildingRoom)
    throw Error("sim:" + options.room + " has no walks to choose from; use building as the room");
  if (first < 0 || last < first || last > kLastWalk)
    throw Error("walks " + std::to_string(first) + ":" + std::to_string(last) +
                ": must be A:B with 0 <= A <= B <= " + std::to_string(kLastWalk));
  std::error_code fault;
  if (std::filesystem::exists(folder) && !is_empty_folder(folder, fault))
    throw Error(folder.string() + ": is not empty; name a new folder for the recordings");
  std::string list;
  for (std::int64_t walk = first; walk <= last; ++walk) {
    SimOptions its_options = options;
    its_options.walk = static_cast<int>(walk);
    std::string number = std::to_string(walk);
    number.insert(0, 4 - number.size(), '0');
    const std::string name = "walk-" + number;
    simulate(folder / name, its_options, format, [&](std::int64_t done, std::int64_t total) {
      if (progress) progress(name, done, total);
    });
    list += name + ": " + name + "\n";
  }
  write_bytes(folder / "recordings.txt", list);
}

}  // namespace roomradar
