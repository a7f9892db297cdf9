// saved_building.hpp: a small building, made from a simulated recording with its recorded poses.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/building/tileset.hpp"
#include "app/cli/open_source.hpp"
#include "mapping/building/building_info.hpp"
#include "mapping/building/tile_grid.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"

namespace roomradar::test {

/// Names a file by its content, as `roomradar building` does.
inline ContentFile named_by_content(const std::filesystem::path& folder, const std::string& stem,
                                    const std::string& extension) {
  namespace fs = std::filesystem;
  const fs::path plain = folder / (stem + extension);
  ContentFile file;
  file.sha256 = sha256_of_file(plain);
  file.bytes = fs::file_size(plain);
  file.name = stem + "." + file.sha256.substr(0, 16) + extension;
  fs::rename(plain, folder / file.name);
  return file;
}

/// Writes a building of one recording to `folder`: tiles of 64 voxels of 4 cm, and every fifth frame as a
/// keyframe. Returns the frames, whose poses are in the building's world.
inline std::vector<Frame> write_small_building(const std::filesystem::path& folder,
                                               const std::string& source_name) {
  namespace fs = std::filesystem;
  fs::create_directories(folder / kTilesFolder);
  fs::create_directories(folder / kRecordingsFolder);
  BuildingInfo info;
  info.grid = {0.04, 64};
  StaticMap map(info.grid.resolution_m);
  std::vector<Frame> frames;
  KeyframeDatabase keyframes;
  const auto source = open_source(source_name, {});
  for (Frame frame; source->next(frame).status == ReadStatus::kFrame;) {
    (void)map.fuse(frame, *frame.T_world_camera);
    if (frames.size() % 5 == 0) {
      keyframes.keyframes.push_back(make_map_keyframe(frame, *frame.T_world_camera));
      keyframes.keyframes.back().frame_index = frame.index;
    }
    frames.push_back(frame);
  }
  for (const TileIndex& index : tiles_of(map, info.grid, kSurfaceReach_voxels)) {
    BuildingTile tile;
    tile.index = index;
    Mesh mesh = extract_tile_surface(map, info.grid, index);
    if (mesh.triangles.empty()) continue;
    const std::string stem = std::string(kTilesFolder) + "/" + name_of(index);
    StaticMap own(info.grid.resolution_m);
    own.add_evidence(map, lowest_voxel(info.grid, index), info.grid.edge_voxels);
    own.write(folder / (stem + ".octree"));
    write_tile_mesh(mesh, folder / (stem + ".mesh"));
    write_unknown_surface(unknown_surface(own, mesh), folder / (stem + ".unknown"));
    for (const Eigen::Vector3f& v : mesh.vertices) tile.surface_world.extend(mesh.origin + v.cast<double>());
    tile.triangles = static_cast<std::int64_t>(mesh.triangles.size());
    tile.mesh_origin = mesh.origin;
    mesh.origin.setZero();
    write_mesh(mesh, folder / (stem + ".glb"));
    tile.octree = named_by_content(folder, stem, ".octree");
    tile.mesh = named_by_content(folder, stem, ".mesh");
    tile.glb = named_by_content(folder, stem, ".glb");
    tile.unknown = named_by_content(folder, stem, ".unknown");
    info.tiles.push_back(tile);
  }
  const std::string stem = std::string(kRecordingsFolder) + "/one";
  write_keyframe_database(keyframes, folder / (stem + ".keyframes"));
  info.recordings.push_back({"one", source_name, static_cast<std::int64_t>(frames.size()),
                             static_cast<std::int64_t>(frames.size()),
                             static_cast<std::int64_t>(keyframes.keyframes.size()), true,
                             named_by_content(folder, stem, ".keyframes")});
  write_tileset(info, folder);
  write_building(info, folder);
  return frames;
}

}  // namespace roomradar::test
