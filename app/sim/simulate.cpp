// simulate.cpp: passes frames to the recording writer, and writes ground truth to separate files.
#include "app/sim/simulate.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/sim/room/room.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sources/formats/image_file.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/make_folder.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {
namespace {

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
  json["noise_scale"] = options.noise_scale;
  const Intrinsics& camera = options.depth_camera;
  json["depth_camera"] = {{"width_px", camera.width_px}, {"height_px", camera.height_px},
                          {"fx_px", camera.fx_px},       {"fy_px", camera.fy_px},
                          {"cx_px", camera.cx_px},       {"cy_px", camera.cy_px}};
  json["registered_colour"] = options.registered_colour;
  return json.dump(2) + "\n";
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
  write_bytes(truth / "sim.json", description(options));
  write_mesh(room_mesh(source.room()), truth / "room.ply");

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
    if (progress) progress(frame.index + 1, options.frames);
  }
  writer.close();
  write_trajectory(truth / "trajectory.txt", trajectory);
}

}  // namespace roomradar
