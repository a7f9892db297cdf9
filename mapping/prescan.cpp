// prescan.cpp: the stages of a prescan, from the first frame to the finished map.
#include "mapping/prescan.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mapping/alignment/rolling_shutter.hpp"
#include "mapping/coverage/coverage.hpp"
#include "mapping/deskewed_source.hpp"
#include "mapping/history/visits.hpp"
#include "mapping/map/changed_map.hpp"
#include "mapping/map/map_merge.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/mesh/ply_file.hpp"
#include "mapping/prescan_passes.hpp"
#include "mapping/revision/chosen_frames.hpp"
#include "mapping/texture/exposure_gains.hpp"
#include "mapping/texture/surface_texture.hpp"
#include "mapping/texture/texture_bake.hpp"
#include "mapping/texture/view_alignment.hpp"
#include "mapping/texture/view_selection.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/process_memory.hpp"

namespace roomradar {
namespace {

constexpr double kMostBytes = 80e6;     // of all views
constexpr double kBytesPerPixel = 2.1;  // of a view: colour, depth of half the size
constexpr double kColourPixels = 640.0 * 480.0;
constexpr double kBakeBytes = 150e6;  // of an atlas and its JPEG

/// Returns each fused frame's pose, and the speed of its image from the poses before and after it.
std::vector<ViewCandidate> candidates_of(const std::vector<FusedFrame>& fused,
                                         const std::vector<TimedPose>& trajectory) {
  std::map<std::int64_t, std::size_t> at;  // index in the trajectory, by frame index
  for (std::size_t i = 0; i < trajectory.size(); ++i) at[trajectory[i].frame_index] = i;
  std::vector<ViewCandidate> candidates;
  for (const FusedFrame& frame : fused) {
    ViewCandidate candidate{frame.T_world_camera};
    if (const auto found = at.find(frame.frame_index); found != at.end()) {
      const TimedPose& before = trajectory[found->second - std::min<std::size_t>(found->second, 1)];
      const TimedPose& after = trajectory[std::min(found->second + 1, trajectory.size() - 1)];
      candidate.image_speed_pxps = image_speed_pxps(
          velocity_of(before.T_world_camera.inverse() * after.T_world_camera, after.stamp_s - before.stamp_s),
          frame.depth_camera);
    }
    candidates.push_back(candidate);
  }
  return candidates;
}

/// Returns how many views the memory allows, by the size of the first chosen frame's picture.
std::size_t most_views(PrescanWork& work, const FusionPass& pass, std::size_t first) {
  Frame frame;
  std::size_t index = 0;
  ChosenFrames(*work.source, pass.fused, {first}, work.times).next(frame, index);
  const double pixels = std::max(kColourPixels, static_cast<double>(frame.colour.pixels.size()));
  return static_cast<std::size_t>(std::max(1.0, kMostBytes / (kBytesPerPixel * pixels)));
}

bool exceeds_cap(const PrescanConfig& config) {
  return config.max_memory_bytes > 0 && static_cast<double>(resident_bytes()) + kMostBytes + kBakeBytes >
                                            static_cast<double>(config.max_memory_bytes);
}

/// Reads at most 160 frames of pass.fused again, chosen by choose_views(), and bakes a texture of the mesh
/// from their colours. Their pictures take at most 80 MB, unless a single one is larger.
/// Returns null, and reads nothing, if the memory would exceed config.max_memory_bytes. Returns null if
/// pass.fused is empty, or if no frame has colour and `earlier` is empty.
///
/// Surface that these frames do not show keeps the colours of `earlier` textures. Stages timed: read (per
/// frame), texture (per frame, then the whole).
/// @param mesh        surface of the map, in the world frame of `trajectory`
/// @param trajectory  poses of the frames, with their stamps
/// @throws Error if the source cannot be rewound
std::shared_ptr<const SurfaceTexture> run_texture_pass(PrescanWork& work,
                                                       const std::vector<TimedPose>& trajectory,
                                                       const FusionPass& pass, const EarlierTextures& earlier,
                                                       const Mesh& mesh) {
  if (exceeds_cap(work.config) || pass.fused.empty()) return nullptr;
  const std::vector<ViewCandidate> candidates = candidates_of(pass.fused, trajectory);
  std::vector<std::size_t> chosen = choose_views(candidates, most_views(work, pass, 0));
  work.show("texture", {});
  std::vector<TextureView> views;
  ChosenFrames frames(*work.source, pass.fused, std::move(chosen), work.times);
  Frame frame;
  double bytes = 0.0;
  for (std::size_t i = 0; frames.next(frame, i);) {
    if (frame.colour.empty()) continue;
    bytes += kBytesPerPixel * static_cast<double>(frame.colour.pixels.size());
    if (bytes > kMostBytes && !views.empty()) break;  // later pictures are larger than the first
    work.times.timed("texture", [&] {
      views.push_back(
          make_texture_view(frame, candidates[i].T_world_camera, mesh, candidates[i].image_speed_pxps));
    });
  }
  SurfaceTexture texture = work.times.timed("texture", [&] {
    even_exposure(mesh, views);
    align_views(mesh, views);
    return bake_texture(mesh, views, earlier);
  });
  views = {};
  release_unused_memory();  // the views' small parts
  if (texture.corners.empty()) return nullptr;
  return std::make_shared<const SurfaceTexture>(std::move(texture));
}

/// Spans of frames without a trusted pose. Unreadable frames in a span are included.
std::vector<FrameSpan> lost_frames(const std::vector<TrackedFrame>& frames) {
  std::vector<FrameSpan> lost;
  bool goes_on = false;
  for (const TrackedFrame& frame : frames) {
    if (!frame.trusted && goes_on)
      lost.back().last = frame.frame_index;
    else if (!frame.trusted)
      lost.push_back({frame.frame_index, frame.frame_index});
    goes_on = !frame.trusted;
  }
  return lost;
}

std::string why_none_trusted(const PrescanWork& work) {
  if (work.config.poses != PoseOrigin::kRecorded) return "is there depth between 0.5 and 6 m in the frames?";
  return "the recording has no poses, or none within the octree's reach of " +
         std::to_string(std::lround(work.reach_m)) + " m: use --poses tracked";
}

std::string why_none_fused(const PrescanWork& work) {
  if (!work.last_fused) return "no frame was left to be fused: fuse_every and hold_out leave out all of them";
  if (work.last_fused == FuseStatus::kOutOfBounds)
    return "no frame could be fused: the poses are out of the octree's reach of " +
           std::to_string(std::lround(work.reach_m)) + " m; take coarser cells";
  return "no frame could be fused; the depth images hold no usable measurement";
}

/// Unobserved regions, and how long it took to find them.
struct TimedCoverage {
  Coverage coverage;
  double ms = 0.0;
};

/// Surveys the coverage on a second thread. Octree and mesh must not change meanwhile.
/// @param earlier  poses of the map that is extended
std::future<TimedCoverage> begin_coverage(const StaticMap& octree, const Mesh& mesh,
                                          std::vector<TimedPose> earlier,
                                          const std::vector<TimedPose>& trajectory) {
  earlier.insert(earlier.end(), trajectory.begin(), trajectory.end());
  return std::async(std::launch::async, [&octree, &mesh, poses = std::move(earlier)] {
    const auto start = std::chrono::steady_clock::now();
    Coverage coverage = survey_coverage(octree, mesh, poses);
    release_unused_memory();  // the frontier of unknown space needs it
    return TimedCoverage{std::move(coverage), ms_since(start)};
  });
}

/// Fills in the map's description, except for the fields that a MapWriter sets.
MapInfo describe_map(const PrescanWork& work, const FusionPass& pass,
                     const std::vector<TimedPose>& trajectory) {
  MapInfo info;
  info.source = without_folders(work.source->name());
  info.sessions = {{info.source, source_id_of(work.source->name()), time_of_visit(), pass.counts.frames_read,
                    static_cast<std::int64_t>(pass.fused.size())}};
  info.frames_read = pass.counts.frames_read;
  info.frames_fused = static_cast<std::int64_t>(pass.fused.size());
  info.up_source = to_string(pass.found.up.source);
  info.settings = {{"resolution_m", format_fixed(work.config.resolution_m, 6)},
                   {kDeviationSetting, format_number(work.config.surface.max_deviation_m)},
                   {kPosesSetting, std::string(to_string(work.config.poses))}};
  if (pass.counts.stopped_for_memory || pass.stopped_for_memory) info.settings[kStoppedSetting] = info.source;
  if (work.config.fuse_every > 1) info.settings["fuse_every"] = std::to_string(work.config.fuse_every);
  if (work.config.hold_out > 0) info.settings["hold_out"] = std::to_string(work.config.hold_out);
  if (work.config.poses == PoseOrigin::kRecorded)
    info.T_world_recorded = pass.T_world_found;
  else if (const auto T_recorded_world = pose_alignment(trajectory, pass.found.recorded))
    info.T_world_recorded = T_recorded_world->inverse();
  return info;
}

}  // namespace

bool is_held_out(std::int64_t frame_index, std::int64_t hold_out) {
  return hold_out > 0 && frame_index % hold_out == hold_out / 2;
}

PrescanResult prescan(FrameSource& source, const PrescanConfig& config, StageTimes& times,
                      const PrescanProgress& progress, PrescanInput start) {
  const double reach_m =
      start.map ? start.map->octree.load().reach_m() : StaticMap(config.resolution_m).reach_m();
  const bool maps_recorded_world = config.poses == PoseOrigin::kRecorded && !start.map;
  PrescanWork work{&source,       config, times, progress, start.checkpoints, reach_m, maps_recorded_world,
                   start.observer};
  if (config.bake_texture && start.map) start.map->texture.load();  // damaged: said before the work
  PrescanResult result;
  PrescanCounts& counts = result.counts;
  SavedMap& map = result.map;

  // First pass: camera poses.
  FusionPass pass = run_tracking_pass(work, start.map);
  map.trajectory = trusted_poses(pass);
  if (map.trajectory.empty())
    throw Error(source.name() + ": no frame has a pose that can be trusted, so there is nothing to map; " +
                why_none_trusted(work));

  // Second pass: fusion.
  DeskewedSource deskewed(source, map.trajectory, pass.counts.timing);
  work.source = &deskewed;
  run_fusion_pass(work, map.trajectory, pass);
  if (pass.fused.empty()) throw Error(source.name() + ": " + why_none_fused(work));

  // Ghost removal.
  if (config.remove_ghosts) run_ghost_removal(work, pass);
  map.octree = std::move(pass.octree);

  // Keyframes. Parts that are not needed any more are saved at once, so that the next stages have the memory.
  map.keyframe_database = std::move(pass.found.keyframe_database);
  transform(map.keyframe_database.load(), pass.T_world_found);
  if (start.writer && !start.map)
    map.keyframe_database = start.writer->write_keyframes(map.keyframe_database.load());
  release_unused_memory();

  // Surface extraction.
  work.show("surface", {});
  map.mesh = times.timed("surface",
                         [&] { return extract_surface(map.octree.load(), config.surface, &result.surface); });
  if (map.mesh.triangles.empty())
    throw Error(source.name() + ": " + std::to_string(pass.fused.size()) + " frames show no surface at " +
                format_number(config.resolution_m) + " m; try another --resolution");
  if (config.bake_texture)
    erase_flat_triangles(map.mesh);  // so that the texture fits the mesh that is read from the map
  release_unused_memory();

  // Unobserved regions; the octree is saved meanwhile.
  const MapCounts octree_counts = map.octree.load().counts();
  auto coverage =
      begin_coverage(map.octree.load(), map.mesh,
                     start.map ? start.map->trajectory : std::vector<TimedPose>{}, map.trajectory);
  std::optional<LazyPart<StaticMap>> saved_octree;
  if (start.writer)
    times.timed("save_octree",
                [&] { saved_octree = start.writer->write_octree(map.octree.load(), map.mesh); });
  TimedCoverage surveyed = coverage.get();
  times.add_ms("coverage", surveyed.ms);
  map.coverage_png = std::move(surveyed.coverage.picture_png);
  result.holes = std::move(surveyed.coverage.holes);
  if (saved_octree) map.octree = std::move(*saved_octree);
  release_unused_memory();

  // Texture.
  if (config.bake_texture) {
    EarlierTextures earlier;
    if (start.map) add_texture_of(*start.map, Eigen::Isometry3d::Identity(), earlier);
    map.texture = run_texture_pass(work, map.trajectory, pass, earlier, map.mesh);
  }

  result.lost = lost_frames(pass.found.frames);
  result.parts = pass.found.parts;
  counts = pass.counts;
  counts.stopped_for_memory |= pass.stopped_for_memory;
  counts.frames_tracked = static_cast<std::int64_t>(map.trajectory.size());
  counts.frames_lost = counts.frames_read - counts.frames_skipped - counts.frames_tracked;
  counts.frames_fused = static_cast<std::int64_t>(pass.fused.size());
  counts.ghost_voxels = pass.ghost_voxels.value_or(0);
  if (config.poses != PoseOrigin::kRecorded) {
    const TrajectoryError error = absolute_trajectory_error(map.trajectory, pass.found.recorded);
    if (error.poses > 0) counts.trajectory_error = error;
  }
  map.info = describe_map(work, pass, map.trajectory);
  if (start.map) {
    append_session(*start.map, map);
    start.map->octree = std::move(map.octree);
    start.map->mesh = std::move(map.mesh);
    start.map->texture = std::move(map.texture);
    start.map->coverage_png = std::move(map.coverage_png);
    map = std::move(*start.map);
  }
  map.info.counts = octree_counts;
  return result;
}

}  // namespace roomradar
