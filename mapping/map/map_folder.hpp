// map_folder.hpp: a prescanned room on disk. The format is in maps/README.md.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mapping/history/visits.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/map/map_files.hpp"
#include "mapping/map/map_info.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/storage/lazy_part.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/texture/surface_texture.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

struct SavedMap {
  MapInfo info;
  LazyPart<StaticMap> octree{StaticMap(0.01)};
  Mesh mesh;
  LazyPart<KeyframeDatabase> keyframe_database{KeyframeDatabase()};
  std::vector<TimedPose> trajectory;
  std::vector<std::uint8_t> coverage_png;  ///< coverage picture; empty: none
  /// Border of unknown space, set by load_map(). Null if the map was not saved before, or was saved by an
  /// earlier version.
  LazyPart<std::shared_ptr<const UnknownSurface>> unknown{std::shared_ptr<const UnknownSurface>()};
  /// Folder of the objects that are kept in the room, set by load_map(); may not exist. A map that is saved gets
  /// them. Empty: none.
  std::filesystem::path objects_folder{};
  /// What made the map; the log of its revisions has it when it is saved.
  VisitNote made{};
  /// Texture of the mesh, or of an earlier mesh (see fits()); null: none.
  LazyPart<std::shared_ptr<const SurfaceTexture>> texture{std::shared_ptr<const SurfaceTexture>()};
};

/// When load_map() reads the keyframes.
enum class KeyframeReading {
  kBefore,     ///< before it returns
  kMeanwhile,  ///< on another thread; load() waits for it. A child forked before must not load them
};

/// Reads a map of this or an earlier format version. Verifies the sizes of all files, and the checksum of
/// each file before parsing it. Octree, unknown surface and texture are read and verified by their load().
/// Throws Error naming the file and the fault. load() of these three, and of keyframes read meanwhile, throws
/// in the same cases, and if the folder was replaced before that part was read.
SavedMap load_map(const std::filesystem::path& folder, KeyframeReading keyframes = KeyframeReading::kBefore);

/// Returns the SHA-256 of the file of the map's octree, 64 hexadecimal digits. Empty if the map was not
/// saved.
std::string octree_checksum(const MapInfo& info);

/// Reads and checks only map.json.
MapInfo load_map_info(const std::filesystem::path& folder);

/// Reads the map's mesh after verifying its checksum. Throws Error naming the file and the fault.
Mesh load_map_mesh(const std::filesystem::path& folder);

/// Reads the map's octree, as load_map_mesh() does.
StaticMap load_map_octree(const std::filesystem::path& folder);

/// Reads the map's keyframes, as load_map_mesh() does.
KeyframeDatabase load_map_keyframes(const std::filesystem::path& folder);

/// Returns the map's texture; null if it has none that fits its mesh. Throws Error if the texture is damaged.
std::shared_ptr<const SurfaceTexture> fitting_texture(const SavedMap& map);

/// Reads the map's mesh and its texture, as load_map_mesh() does. Returns an empty texture (no corners) if
/// the map has none. Also throws if the texture belongs to another mesh.
std::pair<Mesh, SurfaceTexture> load_textured_map_mesh(const std::filesystem::path& folder);

/// Returns one sentence per fault, naming the file; empty for an intact map. Never throws for a damaged map.
std::vector<std::string> verify_map(const std::filesystem::path& folder);

}  // namespace roomradar
