// map_folder.hpp: a prescanned room on disk, saved whole or not at all. The format is in maps/README.md.
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

// Of MapInfo::settings, what is asked for later.
inline constexpr const char* kDeviationSetting = "deviation_m";  ///< SurfaceConfig::max_deviation_m
inline constexpr const char* kPosesSetting = "poses";            ///< PoseOrigin, by its name
inline constexpr const char* kStoppedSetting =
    "stopped_for_memory";  ///< the source of which not all is in it

/// One file of the folder as map.json lists it.
struct MapFile {
  std::uint64_t bytes = 0;
  std::string sha256;  ///< 64 hexadecimal digits
};

/// map.json. What is said of the parts (from `format_version` on) is filled in by save_map and load_map.
struct MapInfo {
  std::string source;  ///< the recordings (folders in full) or devices, "; " between them
  std::int64_t frames_read = 0;
  std::int64_t frames_fused = 0;
  std::string up_source = "none";  ///< accelerometer, plane or none
  /// Recording's world to the map's, +z up.
  Eigen::Isometry3d T_world_recorded = Eigen::Isometry3d::Identity();
  std::map<std::string, std::string> settings;  ///< what prescan ran with, by name

  int format_version = kMapFormatVersion;
  std::string tool_version;
  double resolution_m = 0.0;
  MapCounts counts;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t keyframes = 0;
  std::uint64_t poses = 0;
  /// By name: octree.ot, octree.bt, mesh.ply, places.bin, trajectory.txt, and coverage.png if there is one.
  std::map<std::string, MapFile> files;
};

struct SavedMap {
  MapInfo info;
  StaticMap octree{0.01};
  Mesh mesh;
  Places places;
  std::vector<TimedPose> trajectory;
  std::vector<std::uint8_t> coverage_png;  ///< a picture of what was seen; empty: none
};

/// Tells whether T_world_recorded relates recorded poses to the map: the scan used recorded poses, or its
/// recording had them.
bool knows_recorded_world(const MapInfo& info);

/// How the map's surface is to be extracted anew: as closely as prescan was asked to, where its settings say
/// so. Throws Error if they say what cannot be.
SurfaceConfig surface_config_of(const MapInfo& info);

/// The folder's name without `.`, `..` and a slash at its end. Throws Error if that is no name for a map.
std::filesystem::path tidy_map_name(const std::filesystem::path& folder);

/// Throws Error if the file or folder would lie in a map's folder, which holds nothing but the map's own. An
/// empty path is fine.
void require_outside_maps(const std::filesystem::path& path);
/// The same for what will be put into a folder, which may be a map's itself.
void require_contents_outside_maps(const std::filesystem::path& folder);

/// Throws Error with the reason if save_map would refuse `folder` by its name or by what is in it, or if one
/// of `outputs`, the files and folders that are written besides (empty: none), would lie in it: a check to
/// make before minutes of work.
void require_can_become_map(const std::filesystem::path& folder,
                            std::initializer_list<std::filesystem::path> outputs);

/// Writes the map beside `folder` (folder.partial-PID), syncs it, and puts it in place in one step:
/// afterwards `folder` is the whole new map, or, after an Error, whatever it was before. Parent folders are
/// made. Throws Error if `folder` exists and is not a map (its files are left alone), or the disk does not
/// take the map.
void save_map(const std::filesystem::path& folder, const SavedMap& map);

/// Reads a map, every file checked against its checksum first. Throws Error naming the file and the fault.
SavedMap load_map(const std::filesystem::path& folder);

/// Reads and checks map.json alone.
MapInfo load_map_info(const std::filesystem::path& folder);

/// All faults found, one sentence each naming the file; empty for a sound map. Never throws for a broken map.
std::vector<std::string> verify_map(const std::filesystem::path& folder);

/// Writes one part of the saved map by extension: .ot and .bt the octree; .ply .obj .stl .glb the mesh.
/// Throws Error if the extension is none of these, the map is broken, or `path` lies in a map's folder.
void export_map(const std::filesystem::path& folder, const std::filesystem::path& path);

/// The lines of `roomradar map info`.
std::string describe(const MapInfo& info);

}  // namespace roomradar
