// map_folder.hpp: a prescanned room on disk, saved atomically. The format is in maps/README.md.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

inline constexpr int kMapFormatVersion = 1;

// Keys of MapInfo::settings that are read back.
inline constexpr const char* kDeviationSetting = "deviation_m";  ///< SurfaceConfig::max_deviation_m
inline constexpr const char* kPosesSetting = "poses";            ///< name of the PoseOrigin
inline constexpr const char* kStoppedSetting =
    "stopped_for_memory";  ///< source of which only a part is in the map

/// Entry of one file in map.json.
struct MapFile {
  std::uint64_t bytes = 0;
  std::string sha256;  ///< 64 hexadecimal digits
};

/// Content of map.json. save_map and load_map fill in the fields from `format_version` on.
struct MapInfo {
  std::string source;  ///< recordings (full paths) or devices, separated by "; "
  std::int64_t frames_read = 0;
  std::int64_t frames_fused = 0;
  std::string up_source = "none";  ///< accelerometer, plane or none
  /// From the recording's world to the map's, +z up.
  Eigen::Isometry3d T_world_recorded = Eigen::Isometry3d::Identity();
  std::map<std::string, std::string> settings;  ///< prescan's settings, by name

  int format_version = kMapFormatVersion;
  std::string tool_version;
  double resolution_m = 0.0;
  MapCounts counts;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t keyframes = 0;
  std::uint64_t poses = 0;
  /// By file name: octree.ot, octree.bt, mesh.ply, places.bin, trajectory.txt, and coverage.png if there is
  /// one.
  std::map<std::string, MapFile> files;
};

struct SavedMap {
  MapInfo info;
  StaticMap octree{0.01};
  Mesh mesh;
  KeyframeDatabase keyframe_database;
  std::vector<TimedPose> trajectory;
  std::vector<std::uint8_t> coverage_png;  ///< coverage picture; empty: none
};

/// Returns whether info.T_world_recorded locates recorded poses in the map. True if the map was scanned with
/// recorded poses, or from a recording that had them.
bool knows_recorded_world(const MapInfo& info);

/// Returns the settings for extracting the map's surface again, with prescan's max deviation if info.settings
/// has it. Throws Error if this setting is invalid.
SurfaceConfig surface_config_of(const MapInfo& info);

/// Returns the path without dot components and without a trailing slash. Throws Error if no usable name for a
/// map remains.
std::filesystem::path tidy_map_name(const std::filesystem::path& folder);

/// Throws Error if the file or folder would be directly in a map's folder, which may contain only the map's
/// files. An empty path is allowed.
void require_outside_maps(const std::filesystem::path& path);
/// Same for files to be written into `folder`; also throws if `folder` itself is a map.
void require_contents_outside_maps(const std::filesystem::path& folder);

/// Checks, before minutes of work, whether a map can be saved to `folder`. Throws Error if save_map would
/// refuse its name or its content, or if one of `outputs` would be in it. `outputs` are the other files and
/// folders to be written; empty paths are ignored.
void require_can_become_map(const std::filesystem::path& folder,
                            std::initializer_list<std::filesystem::path> outputs);

/// Writes the map beside `folder` (folder.partial-PID), syncs it, and puts it in place in one step.
/// Afterwards `folder` is the complete new map or, after an Error, unchanged. Creates parent folders. Throws
/// Error if `folder` exists and is not a map (its files are left alone), the map has no surface or too many
/// triangles, or the disk fails.
void save_map(const std::filesystem::path& folder, const SavedMap& map);

/// Reads a map after verifying the checksum of every file. Throws Error naming the file and the fault.
SavedMap load_map(const std::filesystem::path& folder);

/// Reads and checks only map.json.
MapInfo load_map_info(const std::filesystem::path& folder);

/// Returns one sentence per fault, naming the file; empty for an intact map. Never throws for a damaged map.
std::vector<std::string> verify_map(const std::filesystem::path& folder);

/// Exports one part of a saved map, chosen by extension: the octree for .ot and .bt, the mesh for .ply .obj
/// .stl .glb. Throws Error if the extension is none of these, the map is damaged, or `path` is in a map's
/// folder.
void export_map(const std::filesystem::path& folder, const std::filesystem::path& path);

/// Returns the output of `roomradar map info`.
std::string describe(const MapInfo& info);

}  // namespace roomradar
