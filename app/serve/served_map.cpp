// served_map.cpp: reads descriptions immediately, and keyframes on first use.
#include "app/serve/served_map.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/building/building_summary.hpp"
#include "app/building/tileset.hpp"
#include "mapping/building/building_map.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_info.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// Drops patches and previews' spare memory: recognise_place() uses features and previews only.
void drop_patches(KeyframeDatabase& database) {
  for (MapKeyframe& keyframe : database.keyframes) {
    keyframe.patches = std::vector<SurfacePatch>();  // "= {}" would keep the memory
    keyframe.descriptors.shrink_to_fit();
    keyframe.points_camera.shrink_to_fit();
  }
}

}  // namespace

MapSnapshot::MapSnapshot(fs::path folder) : folder_(std::move(folder)) {
  if (is_building(folder_))
    read_building_map();
  else
    read_room_map();
}

void MapSnapshot::read_building_map() {
  kind_ = "building";
  const BuildingSummary summary = summarise_building(folder_);
  building_ = summary.info;
  info_text_ = json_of(summary).dump();
  tileset_text_ = roomradar::tileset_text(summary.info);
  for (const BuildingTile& tile : summary.info.tiles) {
    for (const ContentFile* file : files_of(tile)) files_[file->name] = *file;
    tiles_.push_back({name_of(tile.index), tile.surface_world, tile.glb.name});
  }
}

void MapSnapshot::read_room_map() {
  kind_ = "room";
  const MapInfo info = load_map_info(folder_);
  nlohmann::json text = nlohmann::json::parse(to_json(info));
  text["kind"] = kind_;
  info_text_ = text.dump();
  for (const char* name : {kMapMeshFile, kMapTextureFile}) {
    const auto listed = info.files.find(name);
    if (listed == info.files.end()) continue;
    files_[name] = {name, listed->second.sha256, listed->second.bytes};
  }
  room_keyframes_sha256_ = info.files.at(kMapKeyframesFile).sha256;
}

const KeyframeDatabase& MapSnapshot::keyframes() const {
  const std::lock_guard lock(keyframes_mutex_);
  if (keyframes_) return *keyframes_;
  KeyframeDatabase database;
  if (building_) {
    database = load_building_keyframes(*building_, folder_);
  } else {
    const fs::path path = folder_ / kMapKeyframesFile;
    if (sha256_of_file(path) != room_keyframes_sha256_)
      throw Error(path.string() + ": is not that of map.json; the map was replaced, or is damaged");
    database = read_keyframe_database(path);
    update_index(database);
    drop_patches(database);
  }
  keyframes_ = std::make_unique<const KeyframeDatabase>(std::move(database));
  return *keyframes_;
}

ServedMap::ServedMap(const fs::path& folder) : folder_(fs::absolute(folder).lexically_normal()) {
  if (folder_.filename().empty()) folder_ = folder_.parent_path();  // NAME/
  name_ = folder_.filename().string();
  const bool is_plain =
      !name_.empty() && name_.size() <= 100 && name_.front() != '.' &&
      name_.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") ==
          std::string::npos;
  if (!is_plain)
    throw Error(folder.string() +
                ": the name of a served folder may have letters of a to z, digits, and . _ -");
  (void)current();
}

std::string ServedMap::state_on_disk() const {
  std::string state;
  for (const char* name : {kBuildingFile, kMapInfoFile}) {
    struct stat of {};
    if (::stat((folder_ / name).c_str(), &of) != 0) continue;
    state += std::string(name) + " " + std::to_string(of.st_ino) + " " + std::to_string(of.st_size) + " " +
             std::to_string(of.st_mtim.tv_sec) + "." + std::to_string(of.st_mtim.tv_nsec) + ";";
  }
  return state;
}

std::shared_ptr<const MapSnapshot> ServedMap::current() {
  const std::lock_guard lock(mutex_);
  const std::string state = state_on_disk();  // before reading: a later change is seen at the next call
  if (!snapshot_ || state != state_) {
    snapshot_ = std::make_shared<const MapSnapshot>(folder_);
    state_ = state;
  }
  return snapshot_;
}

}  // namespace roomradar
