// prescan_report.cpp: results of a prescan as JSON and as text.
#include "app/scan/prescan_report.hpp"

#include <algorithm>
#include <cstdio>

#include "app/cli/report.hpp"
#include "mapping/map/level_surfaces.hpp"
#include "mapping/map/map_info.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

nlohmann::json hole_row(const Hole& hole) {
  return {{"kind", to_string(hole.kind)},
          {"position_m", to_json(hole.position_world)},
          {"size_m", hole.size_m},
          {"area_m2", hole.area_m2},
          {"look_direction", to_json(hole.look_direction_world)},
          {"stand_m", hole.viewpoint_world ? to_json(*hole.viewpoint_world) : nlohmann::json(nullptr)}};
}

}  // namespace

nlohmann::json results_of(const PrescanResult& scanned) {
  const PrescanCounts& counts = scanned.counts;
  const MapCounts& octree = scanned.map.info.counts;
  nlohmann::json results = {
      {"frames_tracked", counts.frames_tracked},
      {"frames_fused", counts.frames_fused},
      {"frames_lost", counts.frames_lost},
      {"keyframes", counts.keyframes},
      {"loops_found", counts.loops_found},
      {"tracking_restarts", counts.restarts},
      {"depth_readout_s", counts.timing.depth_readout_s},
      {"colour_readout_s", counts.timing.colour_readout_s},
      {"colour_delay_s", counts.timing.colour_delay_s},
      {"recorded_poses",
       {{"used", counts.recorded_used},
        {"contradicted", counts.recorded_contradicted},
        {"sigma_m", counts.recorded_sigma_m}}},
      {"frames_impossible_motion", counts.impossible_motion},
      {"ghost_voxels", counts.ghost_voxels},
      {"frames_resumed", counts.frames_resumed},
      {"stopped_for_memory", counts.stopped_for_memory},
      {"up_source", scanned.map.info.up_source},
      {"map",
       {{"leaves", octree.occupied_leaves + octree.free_leaves},
        {"occupied_leaves", octree.occupied_leaves},
        {"free_leaves", octree.free_leaves},
        {"bytes", octree.memory_bytes},
        {"triangles", scanned.map.mesh.triangles.size()}}},
      {"surface",
       {{"full_triangles", scanned.surface.full_triangles}, {"deviation_m", scanned.surface.deviation_m}}},
  };
  results["lost"] = nlohmann::json::array();
  for (const FrameSpan& span : scanned.lost)
    results["lost"].push_back({{"from_frame", span.first}, {"until_frame", span.last + 1}});
  results["parts"] = nlohmann::json::array();
  for (const ScanPart& part : scanned.parts)
    results["parts"].push_back({{"from_frame", part.first},
                                {"until_frame", part.last + 1},
                                {"frames", part.frames},
                                {"in_map", part.is_joined}});
  results["holes"] = nlohmann::json::array();
  for (const Hole& hole : scanned.holes) results["holes"].push_back(hole_row(hole));
  results["ate_rmse_m"] = nullptr;  // set only for tracked poses of a recording that has poses
  if (counts.trajectory_error) {
    results["ate_rmse_m"] = counts.trajectory_error->rmse_m;
    results["ate_max_m"] = counts.trajectory_error->max_m;
  }
  results["texture"] = nullptr;
  if (const std::shared_ptr<const SurfaceTexture>& texture = scanned.map.texture.load())
    results["texture"] = {{"width_px", texture->width_px},
                          {"height_px", texture->height_px},
                          {"bytes", texture->atlas_jpeg.size()}};
  if (!counts.last_fault.empty()) results["last_fault"] = counts.last_fault;
  return results;
}

nlohmann::json held_out_json(const HeldOutScore& score) {
  // Figures that could not be measured are omitted; as 0 they would look perfect.
  if (score.frames == 0) return {{"frames", 0}};
  if (score.cover == 0.0) return {{"frames", score.frames}, {"pixels", score.pixels}, {"cover", 0.0}};
  return {{"frames", score.frames}, {"pixels", score.pixels}, {"median_m", score.median_m},
          {"bias_m", score.bias_m}, {"cover", score.cover},   {"outliers", score.outliers}};
}

namespace {

/// Names the parts of the scan that are not in the map, and warns if little of the recording was used.
void print_parts(const PrescanOptions& options, const PrescanResult& scanned) {
  constexpr double kEnough = 0.8;
  for (const ScanPart& part : scanned.parts) {
    if (part.is_joined) continue;
    const long long first = part.first, last = part.last;
    std::printf(
        "a part is not in the map: frames %lld-%lld show no place that the map shows. To add it, record the "
        "way "
        "between the two and run `roomradar prescan WAY --map %s --resume`, then `roomradar prescan %s "
        "--frames "
        "%lld:%lld --map %s --resume`\n",
        first, last, options.map.c_str(), options.source.c_str(), first, last, options.map.c_str());
  }
  const PrescanCounts& counts = scanned.counts;
  const std::int64_t readable = counts.frames_read - counts.frames_skipped;
  if (readable > 0 && static_cast<double>(counts.frames_tracked) < kEnough * static_cast<double>(readable))
    std::printf(
        "warning: only %.0f %% of the frames are in the map; the others have no pose that can be trusted. "
        "Move "
        "more slowly, keep furniture or corners in view, and let views overlap by half; poses of the "
        "recording "
        "help, see --poses\n",
        100.0 * static_cast<double>(counts.frames_tracked) / static_cast<double>(readable));
}

/// Prints a line if the map has level surfaces, none of which is the floor.
void print_floor(const Mesh& mesh_world) {
  const std::vector<LevelSurface> surfaces = level_surfaces(mesh_world);
  const std::vector<bool> is_floor = floor_among(surfaces, mesh_world);
  if (surfaces.empty() || std::find(is_floor.begin(), is_floor.end(), true) != is_floor.end()) return;
  const auto lowest = std::min_element(surfaces.begin(), surfaces.end(),
                                       [](const auto& a, const auto& b) { return a.height_m < b.height_m; });
  std::printf("the floor was not seen: the lowest level surface, at z = %.2f m, has others below it\n",
              rounded(lowest->height_m, 2));
}

}  // namespace

void print_summary(const PrescanOptions& options, const PrescanResult& scanned,
                   const std::optional<HeldOutScore>& held_out) {
  const PrescanCounts& counts = scanned.counts;
  std::printf("%s: %lld of %lld frames tracked, %lld fused, %zu triangles, up %s\n", options.map.c_str(),
              static_cast<long long>(counts.frames_tracked), static_cast<long long>(counts.frames_read),
              static_cast<long long>(counts.frames_fused), scanned.map.mesh.triangles.size(),
              describe_up(scanned.map.info.up_source).c_str());
  if (!scanned.lost.empty()) {
    std::printf("frames without a pose:");
    constexpr std::size_t kShown = 5;
    for (std::size_t i = 0; i < std::min(scanned.lost.size(), kShown); ++i) {
      const FrameSpan& span = scanned.lost[i];
      std::printf("%s %lld", i > 0 ? "," : "", static_cast<long long>(span.first));
      if (span.last > span.first) std::printf("-%lld", static_cast<long long>(span.last));
    }
    if (scanned.lost.size() > kShown) std::printf(" and %zu more spans", scanned.lost.size() - kShown);
    std::printf("\n");
    constexpr std::int64_t kWorthAdvice = 20;  // frames for each that would have jumped, at most
    if (counts.impossible_motion > 0)
      std::printf(
          "in %lld of these the camera would have jumped, so depth does not constrain their poses%s\n",
          static_cast<long long>(counts.impossible_motion),
          counts.impossible_motion * kWorthAdvice < counts.frames_read
              ? ""
              : ". Scan there again, slowly, with edges and corners nearer than 4 m in view, and add "
                "it with --resume");
  }
  print_parts(options, scanned);
  if (counts.frames_skipped > 0) {
    std::printf("%lld frames could not be read; the last fault: %s\n",
                static_cast<long long>(counts.frames_skipped), counts.last_fault.c_str());
  }
  if (scanned.map.info.up_source == to_string(UpSource::kNone))
    std::printf(
        "the up direction is not known: no gravity was recorded and no level surface was found; up is taken "
        "from the first camera. If that is wrong, scan again with --up X,Y,Z or --up camera\n");
  print_floor(scanned.map.mesh);
  if (counts.recorded_used > 0)
    std::printf("recorded poses constrained the motion of %lld frames; their noise is %.1f mm%s\n",
                static_cast<long long>(counts.recorded_used), 1e3 * counts.recorded_sigma_m,
                counts.recorded_contradicted > 0
                    ? ("; depth contradicted them in " + std::to_string(counts.recorded_contradicted) +
                       " frames, which were tracked without them")
                          .c_str()
                    : "");
  if (counts.trajectory_error)
    std::printf("trajectory against the recorded poses: RMSE %.1f mm, max %.1f mm\n",
                1e3 * counts.trajectory_error->rmse_m, 1e3 * counts.trajectory_error->max_m);
  if (held_out && held_out->frames == 0)
    std::printf(
        "no frame was held out that has a pose: --hold-out %lld means frame %lld and every %lldth after it\n",
        static_cast<long long>(options.hold_out), static_cast<long long>(options.hold_out / 2),
        static_cast<long long>(options.hold_out));
  else if (held_out && held_out->cover == 0.0)
    std::printf("%lld frames held out: the mesh is nowhere in their view\n",
                static_cast<long long>(held_out->frames));
  else if (held_out)
    std::printf("%lld frames held out: depth against the mesh %.1f mm median, %.2f %% covered\n",
                static_cast<long long>(held_out->frames), 1e3 * held_out->median_m, 1e2 * held_out->cover);
}

void print_holes(const std::vector<Hole>& holes) {
  constexpr std::size_t kShown = 5;
  const auto inside = std::count_if(holes.begin(), holes.end(), is_inside_scan);
  std::printf("holes: %zu, %td of them inside the scan%s\n", holes.size(), inside,
              inside > 0 ? "; the largest, numbered as in coverage.png and the report:" : "");
  for (std::size_t i = 0; i < std::min(static_cast<std::size_t>(inside), kShown); ++i)
    std::printf("  %zu. %s\n", i + 1, describe(holes[i]).c_str());
}

}  // namespace roomradar
