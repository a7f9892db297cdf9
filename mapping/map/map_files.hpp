// map_files.hpp: names of the files in a map's folder, and checks whether a folder can become a map.
#pragma once
#include <array>
#include <filesystem>
#include <initializer_list>
#include <string>

namespace roomradar {

/// Name of the file that describes a map and lists its other files.
inline constexpr const char* kMapInfoFile = "map.json";
inline constexpr const char* kMapOctreeFile = "octree.bin";
inline constexpr const char* kMapMeshFile = "mesh.ply";
inline constexpr const char* kMapKeyframesFile = "places.bin";
inline constexpr const char* kMapTrajectoryFile = "trajectory.txt";
/// All required files except map.json.
inline constexpr std::array<const char*, 4> kMapParts = {kMapOctreeFile, kMapMeshFile, kMapKeyframesFile,
                                                         kMapTrajectoryFile};
/// Octree of format versions 1 and 2, which also have octree.bt.
inline constexpr const char* kMapOldOctreeFile = "octree.ot";
inline constexpr const char* kMapOldPlainOctreeFile = "octree.bt";
inline constexpr int kLastOldOctreeVersion = 2;
inline constexpr const char* kMapCoverageFile = "coverage.png";  ///< optional
inline constexpr const char* kMapUnknownFile = "unknown.bin";    ///< optional: missing in older maps
inline constexpr const char* kMapTextureFile = "texture.jpg";    ///< optional, with kMapTexturePointsFile
inline constexpr const char* kMapTexturePointsFile = "texture.bin";
/// Folder, optional: the virtual objects that runs keep in the room; see app/objects/kept_objects.hpp. It changes
/// while the map is in use and is not listed in map.json.
inline constexpr const char* kMapObjectsFolder = "objects";

/// Returns true for the names of the files, other than map.json, that a folder with a map of any format
/// version may contain.
bool is_map_part(const std::string& name);

/// Returns true for the names of the files and folders that may lie directly in a map's folder: map.json, the
/// map's parts, objects, and all that begin with "visits".
bool is_map_entry(const std::string& name);

/// Throws Error unless `folder` is missing, empty, or contains a map and nothing else but litter of desktops
/// (is_litter()). Also throws if `folder` is directly in a map's folder.
void require_replaceable(const std::filesystem::path& folder);

/// Returns the path without "." and ".." components and without trailing slash. Throws Error if the result is
/// not usable as a map's name.
std::filesystem::path tidy_map_name(const std::filesystem::path& folder);

/// Throws Error if the file or folder would be directly in a map's folder, which may contain only the map's
/// files. An empty path is allowed.
void require_outside_maps(const std::filesystem::path& path);
/// Checks the path of a folder into which files will be written, as require_outside_maps() does. Also throws
/// if `folder` itself is a map.
void require_contents_outside_maps(const std::filesystem::path& folder);

/// Checks, before minutes of work, whether a map can be saved to `folder`. Throws Error if save_map() would
/// reject the folder's name or present content, or if one of `outputs` would be in `folder`. `outputs` are
/// other files and folders that the caller will write; empty paths are ignored.
void require_can_become_map(const std::filesystem::path& folder,
                            std::initializer_list<std::filesystem::path> outputs);

}  // namespace roomradar
