// building_check.cpp: checks each file, and collects the faults.
#include "app/building/building_check.hpp"

#include <cstdint>
#include <functional>

#include "app/building/tileset.hpp"
#include "mapping/building/building_info.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// Checks a file's size and hash, then its content. `check_content` throws Error if it finds a fault.
void check_file(const ContentFile& file, const fs::path& folder,
                const std::function<void(const fs::path&)>& check_content, std::vector<std::string>& faults) {
  const fs::path path = folder / file.name;
  try {
    std::error_code fault;
    if (!fs::exists(path, fault)) throw Error(path.string() + ": is missing");
    if (!fs::is_regular_file(path, fault)) throw Error(path.string() + ": is not a plain file");
    const std::uintmax_t bytes = fs::file_size(path);
    if (bytes != file.bytes)
      throw Error(path.string() + ": has " + std::to_string(bytes) + " bytes, but building.json says " +
                  std::to_string(file.bytes));
    if (sha256_of_file(path) != file.sha256)
      throw Error(path.string() + ": is damaged: its SHA-256 is not that of building.json");
    check_content(path);
  } catch (const std::exception& fault) {
    faults.emplace_back(fault.what());
  }
}

void require_that(bool holds, const fs::path& path, const std::string& fault) {
  if (!holds) throw Error(path.string() + ": " + fault);
}

void check_octree(const fs::path& path, const TileGrid& grid, const TileIndex& tile) {
  const StaticMap octree = StaticMap::read(path);
  require_that(octree.resolution_m() == grid.resolution_m, path, "has another resolution than the building");
  const Eigen::AlignedBox3d cube = box_of(grid, tile);
  const double rounding_m = 1e-6 * grid.resolution_m;
  const Eigen::AlignedBox3d reach(cube.min().array() - rounding_m, cube.max().array() + rounding_m);
  const Eigen::AlignedBox3d known = octree.counts().known_world;
  require_that(known.isEmpty() || reach.contains(known), path, "has voxels outside its tile");
}

void check_mesh(const fs::path& path, const BuildingTile& tile) {
  const Mesh mesh = read_tile_mesh(path);
  require_that(static_cast<std::int64_t>(mesh.triangles.size()) == tile.triangles, path,
               "has another number of triangles than building.json says");
  for (const Eigen::Vector3f& v : mesh.vertices)
    require_that(tile.surface_world.contains(mesh.origin + v.cast<double>()), path,
                 "has a vertex outside the box that building.json says");
}

void check_glb(const fs::path& path) {
  require_that(read_bytes(path, "a tile's surface").starts_with("glTF"), path, "is not a .glb file");
}

void check_unknown(const fs::path& path, const TileGrid& grid, const TileIndex& tile) {
  constexpr double kMargin_cells = 8.0;  // unknown cells are kept that far round the tile's known space
  const CellGrid cells = read_unknown_surface(path).grid;
  const Eigen::AlignedBox3d cube = box_of(grid, tile);
  const Eigen::Vector3d margin_m = Eigen::Vector3d::Constant(kMargin_cells * cells.cell_m);
  const Eigen::AlignedBox3d reach(cube.min() - margin_m, cube.max() + margin_m);
  const Eigen::Vector3d low = cells.cell_m * cells.first_cell.cast<double>();
  const Eigen::Vector3d high = low + cells.cell_m * cells.size.cast<double>();
  require_that(cells.size.isZero() || (reach.contains(low) && reach.contains(high)), path,
               "has unknown space far outside its tile");
}

void check_keyframes(const fs::path& path, const BuildingRecording& recording) {
  require_that(
      static_cast<std::int64_t>(read_keyframe_database(path).keyframes.size()) == recording.keyframes, path,
      "has another number of keyframes than building.json says");
}

}  // namespace

std::vector<std::string> verify_building(const fs::path& folder) {
  const BuildingInfo info = read_building(folder);
  std::vector<std::string> faults;
  for (const BuildingTile& tile : info.tiles) {
    check_file(
        tile.octree, folder, [&](const fs::path& path) { check_octree(path, info.grid, tile.index); },
        faults);
    check_file(
        tile.mesh, folder, [&](const fs::path& path) { check_mesh(path, tile); }, faults);
    check_file(tile.glb, folder, check_glb, faults);
    if (!tile.unknown.name.empty())
      check_file(
          tile.unknown, folder, [&](const fs::path& path) { check_unknown(path, info.grid, tile.index); },
          faults);
  }
  for (const BuildingRecording& recording : info.recordings)
    if (!recording.keyframe_file.name.empty())
      check_file(
          recording.keyframe_file, folder, [&](const fs::path& path) { check_keyframes(path, recording); },
          faults);
  const fs::path tileset = folder / kTilesetFile;
  try {
    require_that(read_bytes(tileset, "a tileset") == tileset_text(info), tileset,
                 "does not list the tiles of building.json");
  } catch (const Error& fault) {
    faults.emplace_back(fault.what());
  }
  return faults;
}

}  // namespace roomradar
