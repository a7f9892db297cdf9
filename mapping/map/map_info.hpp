// map_info.hpp: content of a map's map.json, and its conversion from and to JSON.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/surface/surface_extraction.hpp"

namespace roomradar {

inline constexpr int kMapFormatVersion = 5;

// Keys of MapInfo::settings that are read back.
inline constexpr const char* kDeviationSetting = "deviation_m";       ///< SurfaceConfig::max_deviation_m
inline constexpr const char* kPosesSetting = "poses";                 ///< name of the PoseOrigin
inline constexpr const char* kStoppedSetting = "stopped_for_memory";  ///< source that did not fit in memory

/// Entry of one file in map.json.
struct MapFile {
  std::uint64_t bytes = 0;
  std::string sha256;  ///< 64 hexadecimal digits
};

/// One scan, or one merged map, from which a map was made.
struct MapSession {
  std::string source;     ///< recording or device, without folders
  std::string source_id;  ///< see source_id_of()
  std::string made_at;    ///< in UTC, as Visit::made_at
  std::int64_t frames_read = 0;
  std::int64_t frames_fused = 0;
};

/// Returns 16 hexadecimal digits by which the same recording at the same place is known again. They do not
/// tell the place.
std::string source_id_of(const std::string& source);

/// Content of map.json. save_map() and load_map() set format_version and all fields declared after it.
struct MapInfo {
  std::string source;                ///< recordings or devices, without folders, separated by "; "
  std::vector<MapSession> sessions;  ///< in order; empty: saved by an earlier version
  std::int64_t frames_read = 0;
  std::int64_t frames_fused = 0;
  std::string up_source = "none";  ///< accelerometer, plane, given or none
  /// Maps points from the recording's to the map's world frame, where +z is up.
  Eigen::Isometry3d T_world_recorded = Eigen::Isometry3d::Identity();
  std::map<std::string, std::string> settings;  ///< prescan's settings, by name

  std::string id;       ///< UUID, the same for all revisions; empty: saved by an earlier version
  std::string created;  ///< when the first revision was saved, as Visit::made_at; empty: not known
  std::string changed;  ///< when this revision was saved
  int format_version = kMapFormatVersion;
  std::string tool_version;
  double resolution_m = 0.0;
  MapCounts counts;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t keyframes = 0;
  std::uint64_t poses = 0;
  int revision = 0;  ///< number of this revision of the map (Visit::revision); 0: saved by an earlier version
  int parent_revision = 0;  ///< revision that was in the folder before; 0: none
  /// Size and checksum by file name. The names are in map_files.hpp.
  std::map<std::string, MapFile> files;
};

/// Returns true if info.T_world_recorded is known: the map was scanned with recorded poses, or the recording
/// had poses.
bool knows_recorded_world(const MapInfo& info);

/// Returns true if the keyframe files of both maps are equal, so that both have the same world frame. This is
/// the case if one map was saved by a run in the other.
bool share_world(const MapInfo& a, const MapInfo& b);

/// Returns the settings for extracting the map's surface again. max_deviation_m is prescan's value if
/// info.settings has one, else the default. Throws Error if the stored value is invalid.
SurfaceConfig surface_config_of(const MapInfo& info);

/// Describes the source of a map's up direction for users: "from gravity", "from a level surface", "as given
/// by --up" or "not known". Returns up_source itself if it is not a valid MapInfo::up_source.
std::string describe_up(const std::string& up_source);

/// Returns the output of `roomradar map info`.
std::string describe(const MapInfo& info);

std::string to_json(const MapInfo& info);

/// Parses and validates the text of map.json. Throws Error if the text is not JSON, not a map's or of a later
/// format version. Also throws if a field is missing, of the wrong type or out of range. The message starts
/// with `where` (the file's path) and names the fault.
MapInfo parse_map_info(const std::string& text, const std::string& where);

}  // namespace roomradar
