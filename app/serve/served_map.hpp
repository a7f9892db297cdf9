// served_map.hpp: a served map, reloaded after its replacement on disk.
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "mapping/building/building_info.hpp"
#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// A tile, and the bounding box of its surface.
struct ServedTile {
  std::string name;
  Eigen::AlignedBox3d box_world;  ///< bounding box of the surface, m
  std::string glb;                ///< path relative to the map's folder, such as tiles/0_0_0.1234.glb
};

/// A loaded version of a map. Immutable: a map that is replaced on disk is loaded as a new object.
class MapSnapshot {
 public:
  /// Reads the map's description. Throws Error naming the file and the fault.
  explicit MapSnapshot(std::filesystem::path folder);

  /// Output of `roomradar map info --json`.
  [[nodiscard]] const std::string& info_text() const { return info_text_; }
  /// Text of tileset.json; empty for the map of a room.
  [[nodiscard]] const std::string& tileset_text() const { return tileset_text_; }
  /// "building" or "room".
  [[nodiscard]] const std::string& kind() const { return kind_; }
  [[nodiscard]] const std::vector<ServedTile>& tiles() const { return tiles_; }
  /// The files that may be served, by path relative to the map's folder. No other file is served.
  [[nodiscard]] const std::map<std::string, ContentFile>& files() const { return files_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// The keyframe data for recognise_place(), read at the first call. Thread safe. Throws Error if the
  /// keyframes are missing or damaged.
  [[nodiscard]] const KeyframeDatabase& keyframes() const;

 private:
  void read_building_map();
  void read_room_map();

  std::filesystem::path folder_;
  std::string kind_, info_text_, tileset_text_;
  std::vector<ServedTile> tiles_;
  std::map<std::string, ContentFile> files_;
  std::optional<BuildingInfo> building_;
  std::string room_keyframes_sha256_;
  mutable std::mutex keyframes_mutex_;
  mutable std::unique_ptr<const KeyframeDatabase> keyframes_;
};

/// A map and its name. Thread safe.
class ServedMap {
 public:
  /// Reads the map. Throws Error naming the file and the fault, also if the folder's name cannot be part of a
  /// URL.
  explicit ServedMap(const std::filesystem::path& folder);

  /// Name in URLs: the folder's name.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Returns the current version of the map. Reloads the map if building.json or map.json was replaced since
  /// the last call. Throws Error if the new version cannot be read.
  [[nodiscard]] std::shared_ptr<const MapSnapshot> current();

 private:
  /// Returns a text that changes whenever building.json or map.json is replaced.
  [[nodiscard]] std::string state_on_disk() const;

  std::filesystem::path folder_;
  std::string name_;
  std::mutex mutex_;
  std::string state_;
  std::shared_ptr<const MapSnapshot> snapshot_;
};

}  // namespace roomradar
