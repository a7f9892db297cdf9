// building_steps.cpp: reads each step's input files, calls the mapping library, and writes the output files.
#include "app/building/building_steps.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/cli/open_source.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "mapping/building/building_info.hpp"
#include "mapping/building/keyframe_retrieval.hpp"
#include "mapping/building/submap_join.hpp"
#include "mapping/building/tile_grid.hpp"
#include "mapping/deskewed_source.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/map/level_surfaces.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/prescan_passes.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kPlacedMagic = "RRPLACED";
constexpr std::uint32_t kPlacedVersion = 1;

/// Fuses the frames and removes ghosts, as prescan() does.
StaticMap fused(FrameSource& source, const Submap& submap, const std::vector<TimedPose>& trajectory,
                const FuseStep& step) {
  PrescanConfig config;
  config.resolution_m = step.grid.resolution_m;
  StageTimes times;
  const PrescanProgress no_progress;
  FusionPass pass;
  pass.counts.frames_read = submap.frames_read;
  pass.octree = StaticMap(config.resolution_m);
  DeskewedSource deskewed(source, trajectory, submap.timing);
  PrescanWork work{&deskewed, config, times, no_progress, nullptr, pass.octree.reach_m()};
  run_fusion_pass(work, trajectory, pass);
  if (pass.fused.empty())
    throw Error(source.name() + ": no frame could be fused; is the recording within " +
                std::to_string(static_cast<int>(work.reach_m)) + " m of the building's origin?");
  if (step.remove_ghosts) run_ghost_removal(work, pass);
  return std::move(pass.octree);
}

/// Moves a submap's world: its origin comes to the floor below the first camera, if a floor is measured.
void put_origin_on_floor(Submap& submap) {
  const Eigen::Vector3d first = submap.trajectory.front().T_world_camera.translation();
  const double floor_m = floor_height_m(submap.keyframes, Eigen::Vector3d::UnitZ()).value_or(first.z());
  const Eigen::Isometry3d T_new_old(Eigen::Translation3d(-first.x(), -first.y(), -floor_m));
  for (TimedPose& frame : submap.trajectory) frame.T_world_camera = T_new_old * frame.T_world_camera;
  transform(submap.keyframes, T_new_old);
}

}  // namespace

int run(const TrackStep& step) {
  SourceOptions options;
  options.questions = Questions::kDepth;
  const std::unique_ptr<FrameSource> source = open_source(step.source, {}, {}, options);
  PrescanConfig config;
  config.poses = step.poses;
  StageTimes times;
  const PrescanProgress no_progress;
  PrescanWork work{source.get(), config,  times,
                   no_progress,  nullptr, StaticMap(config.resolution_m).reach_m()};
  std::optional<SavedMap> no_map;
  FusionPass pass = run_tracking_pass(work, no_map);

  Submap submap;
  submap.source = source->name();
  submap.frames_read = pass.counts.frames_read;
  submap.timing = pass.counts.timing;
  submap.trajectory = trusted_poses(pass);
  submap.recorded = std::move(pass.found.recorded);
  if (submap.trajectory.empty())
    throw Error(source->name() +
                ": no frame has a pose that can be trusted; is there depth between 0.5 and 6 m "
                "in the frames?");
  submap.keyframes = std::move(pass.found.keyframe_database);
  transform(submap.keyframes, pass.T_world_found);
  std::stable_sort(submap.keyframes.keyframes.begin(), submap.keyframes.keyframes.end(),
                   [](const MapKeyframe& a, const MapKeyframe& b) { return a.frame_index < b.frame_index; });
  submap.keyframes.index = {};
  constexpr std::int64_t kMaxGap = 3;
  constexpr std::size_t kMinFrames = 10;
  std::vector<Submap> parts = split_at_losses(submap, kMaxGap, kMinFrames);
  if (parts.empty()) throw Error(source->name() + ": tracking was lost again and again; move more slowly");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (step.poses != PoseOrigin::kRecorded) put_origin_on_floor(parts[i]);
    make_folder(step.out / std::to_string(i));
    save_submap(parts[i], step.out / std::to_string(i));
    save_features(features_of(parts[i]), step.out / std::to_string(i) / kFeaturesFile);
  }
  std::printf("%s: %zu of %lld frames tracked, %zu keyframes, %zu parts\n", submap.source.c_str(),
              submap.trajectory.size(), static_cast<long long>(submap.frames_read),
              submap.keyframes.keyframes.size(), parts.size());
  return 0;
}

int run(const RetrieveStep& step) {
  const auto load = [](const std::vector<fs::path>& files) {
    std::vector<SubmapFeatures> group;
    std::transform(files.begin(), files.end(), std::back_inserter(group), load_features);
    return group;
  };
  const std::vector<SubmapFeatures> a = load(step.a), b = load(step.b);
  save_similarity(step.b.empty() ? compare_within(a) : compare_groups(a, b), step.out / kSimilarityFile);
  std::printf("%zu recordings, compared with %zu\n", a.size(), step.b.empty() ? a.size() : b.size());
  return 0;
}

int run(const JoinStep& step) {
  const Submap a = load_submap(step.a), b = load_submap(step.b);
  const std::vector<SubmapJoin> joins = join_submaps(a, b, similar_keyframes(a, b));
  save_joins(joins, step.out / "joins.bin");
  for (const SubmapJoin& join : joins)
    std::printf("%s and %s: %s\n", a.source.c_str(), b.source.c_str(), describe(join).c_str());
  return 0;
}

int run(const FuseStep& step) {
  require_valid(step.grid);
  if (step.submaps.size() != step.placed.size())
    throw Error("--placed: there are " + std::to_string(step.placed.size()) + " files of poses for " +
                std::to_string(step.submaps.size()) + " submaps; give one file per submap");
  Submap submap;  // of all parts
  std::vector<TimedPose> trajectory;
  KeyframeDatabase keyframes;
  for (std::size_t i = 0; i < step.submaps.size(); ++i) {
    Submap part = load_submap(step.submaps[i]);
    const std::vector<Eigen::Isometry3d> placed = load_placed_keyframes(step.placed[i]);
    if (placed.size() != part.keyframes.keyframes.size())
      throw Error(step.placed[i].string() + ": has poses of another recording");
    const std::vector<TimedPose> corrected = corrected_trajectory(part, placed);
    trajectory.insert(trajectory.end(), corrected.begin(), corrected.end());
    for (std::size_t k = 0; k < placed.size(); ++k) {
      part.keyframes.keyframes[k].T_world_camera = placed[k];
      keyframes.keyframes.push_back(std::move(part.keyframes.keyframes[k]));
    }
    submap.source = part.source;
    submap.frames_read = part.frames_read;
    submap.timing = part.timing;
  }
  write_keyframe_database(keyframes, step.out / kPlacedKeyframesFile);
  keyframes = {};  // their memory is needed for fusion
  const std::unique_ptr<FrameSource> source = open_source(step.source, {});
  const StaticMap map = fused(*source, submap, trajectory, step);
  constexpr int kCell_voxels = 4;  // a triangle in a tile's cube has its samples at most this far outside
  const std::vector<TileIndex> own = tiles_of(map, step.grid, kCell_voxels);
  const std::vector<TileIndex> near = tiles_of(map, step.grid, kSurfaceReach_voxels);
  const std::vector<TileIndex> observed = observed_tiles(map, step.grid);
  std::vector<TileIndex> all;
  std::set_union(near.begin(), near.end(), observed.begin(), observed.end(), std::back_inserter(all),
                 is_before);
  for (const char* folder : {"parts", "margins"}) make_folder(step.out / folder);
  for (const TileIndex& tile : all) {
    const bool is_own = std::binary_search(own.begin(), own.end(), tile, is_before);
    StaticMap part(step.grid.resolution_m);
    part.add_evidence(map, lowest_voxel(step.grid, tile) - VoxelIndex::Constant(kSurfaceReach_voxels),
                      step.grid.edge_voxels + 2 * kSurfaceReach_voxels);
    part.write(step.out / (is_own ? "parts" : "margins") / (name_of(tile) + ".octree"));
  }
  std::printf("%s: %zu frames, surface in %zu tiles\n", submap.source.c_str(), trajectory.size(), own.size());
  return 0;
}

int run(const TileStep& step) {
  require_valid(step.grid);
  const TileIndex tile = tile_of_name(step.tile);
  StaticMap map(step.grid.resolution_m);
  for (const fs::path& part : step.parts) map.add_evidence(StaticMap::read(part));
  SurfaceConfig config;
  config.max_deviation_m = static_cast<float>(step.deviation_m);
  Mesh mesh = extract_tile_surface(map, step.grid, tile, config);
  json facts = {{"triangles", mesh.triangles.size()}};
  if (!mesh.triangles.empty()) {
    StaticMap own(step.grid.resolution_m);
    own.add_evidence(map, lowest_voxel(step.grid, tile), step.grid.edge_voxels);
    own.write(step.out / "tile.octree");
    write_tile_mesh(mesh, step.out / "tile.mesh");
    write_unknown_surface(unknown_surface(own, mesh, {.max_cells = step.unknown_cells}),
                          step.out / "tile.unknown");
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& v : mesh.vertices) box.extend(mesh.origin + v.cast<double>());
    const auto array_of = [](const Eigen::Vector3d& v) { return json{v.x(), v.y(), v.z()}; };
    facts.update({{"surface_min_m", array_of(box.min())},
                  {"surface_max_m", array_of(box.max())},
                  {"mesh_origin_m", array_of(mesh.origin)}});
    mesh.origin.setZero();
    write_mesh(mesh, step.out / "tile.glb");
  }
  write_bytes(step.out / "tile.json", facts.dump(1) + "\n");
  std::printf("tile %s: %zu parts, %zu triangles\n", step.tile.c_str(), step.parts.size(),
              mesh.triangles.size());
  return 0;
}

void save_placed_keyframes(const std::vector<Eigen::Isometry3d>& T_building_keyframe, const fs::path& path) {
  save_binary(path, kPlacedMagic, kPlacedVersion, T_building_keyframe);
}

std::vector<Eigen::Isometry3d> load_placed_keyframes(const fs::path& path) {
  std::vector<Eigen::Isometry3d> poses;
  load_binary(path, kPlacedMagic, kPlacedVersion, poses);
  return poses;
}

}  // namespace roomradar
