// grid_command.cpp: roomradar fallthrough SOURCE: drops over a grid in a recorded room.
#include "app/commands/grid_command.hpp"

#include <cstdio>
#include <string_view>

#include "app/cli/deferred_errors.hpp"
#include "app/cli/open_source.hpp"
#include "app/cli/registered_maps.hpp"
#include "app/cli/report.hpp"
#include "app/evaluation/fallthrough/recording_grid.hpp"
#include "app/media/picture_file.hpp"
#include "mapping/localization/locator.hpp"
#include "mapping/types/pose_origin.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Reads the source's first readable frame and returns its camera's pose in the map.
Eigen::Isometry3d read_located(const FallthroughOptions& options, const SavedMap& map, GlContext& context,
                               Frame& frame) {
  const auto source = open_source(options.source, options.frames, options.calibration);
  ReadResult read = source->next(frame);
  while (read.status != ReadStatus::kFrame && read.status != ReadStatus::kEnd) read = source->next(frame);
  if (read.status == ReadStatus::kEnd) throw Error(source->name() + ": there is no readable frame");
  if (options.poses == PoseOrigin::kRecorded) {
    if (!frame.T_world_camera)
      throw Error(source->name() + ": frame " + std::to_string(frame.index) +
                  " has no recorded pose; use --poses tracked");
    return map.info.T_world_recorded * *frame.T_world_camera;
  }
  Shape room(context);
  room.set(map.mesh, MeshUsage::kStatic);
  FrameScene scene(context, room, {});
  Locator locator;
  const Tracking tracking = locate(locator, frame, map.keyframe_database.load(), {},
                                   [&](const Eigen::Isometry3d& T_world_camera) -> const DepthImage& {
                                     return scene.render_expected(frame.depth_camera, T_world_camera).depth_m;
                                   });
  if (!locator.T_world_camera)
    throw Error(source->name() + ": frame " + std::to_string(frame.index) + " is not found in the map (" +
                std::string(to_string(tracking.status)) + "); choose another frame with --frames A:A");
  return tracking.T_world_camera;
}

/// Returns a map's source without the ", frames A:B" of limit_frames(). A list of sources is unchanged: their
/// poses have different worlds.
std::string_view recording_of(std::string_view source) {
  constexpr std::string_view kFrames = ", frames ";
  const std::size_t at = source.rfind(kFrames);
  if (at == std::string_view::npos || source.find("; ") != std::string_view::npos) return source;
  const std::string_view range = source.substr(at + kFrames.size());
  return range.find_first_not_of("0123456789:") == std::string_view::npos ? source.substr(0, at) : source;
}

/// Returns the reference's surface in the map's world frame.
Mesh reference_of(const FallthroughOptions& options, const SavedMap& map, Report& report) {
  if (options.reference.empty()) return map.mesh;
  SavedMap reference = load_map(options.reference);
  const Eigen::Isometry3d T_map_reference =
      share_recorded_world(map.info, reference.info)
          ? map.info.T_world_recorded * reference.info.T_world_recorded.inverse()
          : require_registered(map, reference, options.map, options.reference, report).T_a_b;
  Mesh& mesh = reference.mesh;
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (T_map_reference.linear() * vertex.cast<double>()).cast<float>();
  mesh.origin = T_map_reference * mesh.origin;
  mesh.normals.clear();
  return mesh;
}

}  // namespace

int run_grid(const FallthroughOptions& options) {
  Report report;
  report.command = "fallthrough";
  report.source = options.source;
  require_png_name(options.picture);
  for (const std::string& path : {options.report, options.picture}) require_writable(path);
  const SavedMap map = load_map(options.map);
  if (options.poses == PoseOrigin::kRecorded) require_recorded_world(map.info, options.map, options.source);
  const Mesh reference_world = reference_of(options, map, report);
  GlContext context;
  report.renderer = context.renderer();
  Frame frame;
  const Eigen::Isometry3d T_world_camera = read_located(options, map, context, frame);
  report.frames_read = 1;
  GridConfig config;
  config.cell_m = options.cell_m;
  config.radar = options.radar;
  const Grid grid = report.times.timed(
      "drops", [&] { return drop_over_grid(context, map, frame, T_world_camera, reference_world, config); });

  std::printf("frame %lld of %s in %s; truth: the surface of %s\n%s", static_cast<long long>(frame.index),
              options.source.c_str(), options.map.c_str(),
              options.reference.empty() ? "this map, so `map` can differ only where something is dynamic"
                                        : options.reference.c_str(),
              table_of(grid).c_str());
  report.settings = {{"map", options.map},
                     {"reference", options.reference.empty() ? options.map : options.reference},
                     {"poses", to_string(options.poses)},
                     {"cell_m", config.cell_m},
                     {"radar", std::string(to_string(config.radar))},
                     {"radius_m", config.radius_m}};
  if (!options.calibration.empty()) report.settings["calibration"] = options.calibration;
  if (options.frames) report.settings["frames"] = {options.frames->first, options.frames->last};
  report.results["frame"] = frame.index;
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    nlohmann::json& policy = report.results["policies"][std::string(kFallthroughPolicies[i].name)];
    for (const bool hidden_only : {true, false}) {
      const GridTotals totals = totals_of(grid, i, hidden_only);
      nlohmann::json rested_on = nlohmann::json::object();
      for (std::size_t kind = 0; kind < totals.rested_on.size(); ++kind)
        if (totals.rested_on[kind] > 0)
          rested_on[std::string(to_string(static_cast<SurfaceKind>(kind)))] = totals.rested_on[kind];
      policy[hidden_only ? "hidden" : "all"] = {{"cells", totals.cells},
                                                {"passed", totals.passed},
                                                {"false_stops", totals.false_stops},
                                                {"false_stops_at_unknown", totals.false_stops_at_unknown},
                                                {"rested_on", rested_on}};
    }
  }
  DeferredErrors faults;
  faults.attempt([&] {
    if (!options.picture.empty()) write_png(draw_plan(grid), options.picture);
  });
  faults.attempt([&] { write_report(report, options.report); });
  faults.throw_first();
  return 0;
}

bool share_recorded_world(const MapInfo& a, const MapInfo& b) {
  return recording_of(a.source) == recording_of(b.source) && knows_recorded_world(a) &&
         knows_recorded_world(b);
}

}  // namespace roomradar
