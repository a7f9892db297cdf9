// building_info.hpp: building.json, which lists the recordings and the tiles of a building.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mapping/building/tile_grid.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A file of a building, named by its content.
struct ContentFile {
  std::string name;    ///< relative to the building's folder
  std::string sha256;  ///< in hexadecimal digits
  std::uintmax_t bytes = 0;
};

struct BuildingTile {
  TileIndex index = TileIndex::Zero();
  std::int64_t triangles = 0;
  Eigen::AlignedBox3d surface_world;  ///< bounding box of the tile's surface, m
  ContentFile octree;                 ///< file of StaticMap::write() with the voxels in the tile's cube only
  ContentFile mesh;                   ///< file of write_tile_mesh()
  ContentFile glb;                    ///< the same mesh relative to mesh_origin, y up
  /// File of write_unknown_surface(): border of unknown space within the cube. Space beyond the cube counts
  /// as unknown, so the border is closed at the cube's faces. The name is empty if the building was made by
  /// an earlier version.
  ContentFile unknown;
  Eigen::Vector3d mesh_origin = Eigen::Vector3d::Zero();
};

struct BuildingRecording {
  std::string name;
  std::string source;
  std::int64_t frames_read = 0, frames_tracked = 0, keyframes = 0;
  /// Number of tracked frames with a pose in the building. Only these frames are fused into the tiles. A
  /// recording, or its part after a loss of tracking, has none if no join connects it with the others.
  std::int64_t frames_placed = 0;
  /// Placed keyframes with their poses in the building; see write_keyframe_database(). The name is empty if
  /// none is placed, or the building was made by an earlier version.
  ContentFile keyframe_file{};
};

/// Content of building.json.
struct BuildingInfo {
  TileGrid grid;
  std::vector<BuildingRecording> recordings;
  std::vector<BuildingTile> tiles;  ///< in the order of is_before()
  /// Pairs of places that look alike, see find_look_alikes(). Empty if the building was made by an earlier
  /// version.
  std::vector<LookAlike> look_alikes;
};

inline constexpr const char* kBuildingFile = "building.json";
inline constexpr const char* kTilesFolder = "tiles";
/// Name of the folder with each recording's trajectory and keyframes in the building's world frame.
inline constexpr const char* kRecordingsFolder = "recordings";

/// Returns the tile's files that have a name.
std::vector<const ContentFile*> files_of(const BuildingTile& tile);

/// Returns true if the folder holds a building.
bool is_building(const std::filesystem::path& folder);
/// Reads building.json. Throws Error naming the file and the fault if it is missing, damaged, of another
/// format version, or names files outside the folder.
BuildingInfo read_building(const std::filesystem::path& folder);
/// Writes building.json, whole or not at all. Throws Error if it cannot be written.
void write_building(const BuildingInfo& info, const std::filesystem::path& folder);

/// Writes a tile's mesh with a checksum. Throws Error if the file cannot be written.
void write_tile_mesh(const Mesh& mesh, const std::filesystem::path& path);
/// Reads a tile's mesh. Throws Error naming the file and the fault if it is missing or damaged.
Mesh read_tile_mesh(const std::filesystem::path& path);

}  // namespace roomradar
