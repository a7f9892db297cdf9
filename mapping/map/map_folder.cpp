// map_folder.cpp: verifies and loads a map.
#include "mapping/map/map_folder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string_view>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/map/map_info.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/storage/atomic_folder.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/texture/surface_texture.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/process_memory.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxPictureBytes = 1U << 26U;
constexpr std::uintmax_t kMaxInfoBytes = 1U << 20U;

[[noreturn]] void fail(const fs::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

// Compares a file's kind and size with map.json; returns the fault, or nullopt if they agree. Refuses a file
// that exceeds the machine's memory.
std::optional<std::string> size_fault_of(const fs::path& path, const MapFile& expected) {
  std::error_code fault;
  const fs::file_status status = fs::symlink_status(path, fault);
  if (!fs::exists(status)) return path.string() + ": is missing";
  if (!fs::is_regular_file(status)) return path.string() + ": is not a plain file";
  const std::uintmax_t bytes = fs::file_size(path, fault);
  if (fault) return path.string() + ": cannot be read: " + system_reason(fault);
  if (bytes != expected.bytes)
    return path.string() + ": has " + std::to_string(bytes) + " bytes, and " + kMapInfoFile + " says " +
           std::to_string(expected.bytes) +
           (bytes < expected.bytes ? "; it is cut short" : "; it was altered");
  if (const std::uint64_t most = machine_bytes(); most > 0 && bytes > most)
    return path.string() + ": has " + std::to_string(bytes) + " bytes, and this machine's memory " +
           std::to_string(most) + "; it cannot be read here";
  return std::nullopt;
}

// Compares a file's kind, size and checksum with map.json; returns the fault, or nullopt if they agree.
std::optional<std::string> fault_of(const fs::path& path, const MapFile& expected) {
  if (auto fault = size_fault_of(path, expected)) return fault;
  try {
    if (sha256_of_file(path) != expected.sha256)
      return path.string() + ": was altered: its checksum is another";
  } catch (const Error& error) {
    return error.what();
  }
  return std::nullopt;
}

bool has_old_octree(const MapInfo& info) { return info.format_version <= kLastOldOctreeVersion; }

const char* octree_file_of(const MapInfo& info) {
  return has_old_octree(info) ? kMapOldOctreeFile : kMapOctreeFile;
}

// Checks that map.json lists all required parts, optionally others of a map, and nothing else. Thus no listed
// path can lead out of the folder.
void require_parts(const MapInfo& info, const fs::path& where) {
  for (const char* part : kMapParts) {
    const char* const name = part == kMapOctreeFile ? octree_file_of(info) : part;
    if (!info.files.contains(name)) fail(where, std::string("does not list \"") + name + "\"");
  }
  for (const auto& [name, file] : info.files)
    if (!is_map_part(name)) fail(where, "lists \"" + name.substr(0, 100) + "\", which is not part of a map");
}

std::vector<std::uint8_t> read_picture(const fs::path& path) {
  const std::string bytes = read_bytes(path, "a map's picture", kMaxPictureBytes);
  return {bytes.begin(), bytes.end()};
}

StaticMap read_octree(const fs::path& folder, const MapInfo& info) {
  const fs::path path = folder / octree_file_of(info);
  StaticMap octree = has_old_octree(info) ? StaticMap::read_ot(path) : StaticMap::read(path);
  if (std::abs(octree.resolution_m() - info.resolution_m) > 1e-9 * info.resolution_m)
    fail(path, "its resolution is not the one in " + std::string(kMapInfoFile));
  return octree;
}

MapInfo read_info(const fs::path& folder) {
  std::error_code fault;
  if (const fs::path aside = interrupted_replacement_of(folder); !aside.empty())
    fail(folder, "a save was killed while it took this map's place, and left it as " +
                     aside.filename().string() + "; rename that to " + folder.filename().string());
  if (fs::is_regular_file(folder, fault)) fail(folder, "is a file; a map is a folder, give that");
  if (!fs::is_directory(folder, fault))
    fail(folder, "there is no such map folder; make one with `roomradar prescan`");
  const fs::path path = folder / kMapInfoFile;
  const fs::file_status status = fs::symlink_status(path, fault);
  if (!fs::exists(status) && fs::exists(folder / "building.json", fault))
    fail(folder, "is the map of a building; this takes the map of one room, made with `roomradar prescan`");
  if (!fs::exists(status)) fail(path, "is missing, so the folder is not a map");
  if (!fs::is_regular_file(status))
    fail(path, "is not a plain file, but a link or a folder; a map contains only plain files");
  MapInfo info = parse_map_info(read_bytes(path, "a map's description", kMaxInfoBytes), path.string());
  require_parts(info, path);
  return info;
}

void throw_if(const std::optional<std::string>& fault) {
  if (fault) throw Error(*fault + "; take the map from a backup or scan the room again");
}
void require_sound(const fs::path& folder, const MapInfo& info, const std::string& name) {
  throw_if(fault_of(folder / name, info.files.at(name)));
}

// Returns a part that is read from these files when it is first used, if the folder still is the map that was
// opened.
template <typename Part, typename Read>
LazyPart<Part> read_later(const fs::path& folder, const MapInfo& info, const std::vector<std::string>& names,
                          const Read& read) {
  return LazyPart<Part>([folder, info, names, read, version = folder_version(folder)]() -> Part {
    if (folder_version(folder) != version)
      fail(folder, "was saved again while it was in use; start again to use the map that is there now");
    for (const std::string& name : names) require_sound(folder, info, name);
    return read(folder, info);
  });
}

// Returns the part, which another thread begins to read now.
template <typename Part>
LazyPart<Part> read_meanwhile(LazyPart<Part> part) {
  const auto whole = std::make_shared<LazyPart<Part>>(std::move(part));
  const std::shared_future<void> reading = std::async(std::launch::async, [whole] { whole->load(); }).share();
  return LazyPart<Part>([whole, reading] {
    reading.get();
    return std::move(whole->load());
  });
}

std::shared_ptr<const UnknownSurface> read_unknown(const fs::path& folder, const MapInfo&) {
  return std::make_shared<const UnknownSurface>(read_unknown_surface(folder / kMapUnknownFile));
}

bool has_texture(const MapInfo& info) {
  return info.files.contains(kMapTextureFile) && info.files.contains(kMapTexturePointsFile);
}

SurfaceTexture read_texture(const fs::path& folder) {
  return read_surface_texture(folder / kMapTextureFile, folder / kMapTexturePointsFile);
}

KeyframeDatabase read_keyframes(const fs::path& folder, const MapInfo&) {
  return read_keyframe_database(folder / kMapKeyframesFile, FileChecksum::kNotNeeded);
}

SavedMap read_map(const fs::path& folder) {
  SavedMap map;
  map.info = read_info(folder);
  const MapInfo& info = map.info;
  for (const auto& [name, file] : info.files) throw_if(size_fault_of(folder / name, file));
  map.keyframe_database =
      read_meanwhile(read_later<KeyframeDatabase>(folder, info, {kMapKeyframesFile}, read_keyframes));
  require_sound(folder, info, kMapMeshFile);
  map.mesh = read_mesh(folder / kMapMeshFile);
  require_sound(folder, info, kMapTrajectoryFile);
  map.trajectory = read_trajectory(folder / kMapTrajectoryFile);
  if (info.files.contains(kMapCoverageFile)) {
    require_sound(folder, info, kMapCoverageFile);
    map.coverage_png = read_picture(folder / kMapCoverageFile);
  }
  map.objects_folder = folder / kMapObjectsFolder;
  map.octree = read_later<StaticMap>(folder, info, {octree_file_of(info)}, read_octree);
  if (info.files.contains(kMapUnknownFile))
    map.unknown =
        read_later<std::shared_ptr<const UnknownSurface>>(folder, info, {kMapUnknownFile}, read_unknown);
  if (has_texture(info))
    map.texture = read_later<std::shared_ptr<const SurfaceTexture>>(
        folder, info, {kMapTextureFile, kMapTexturePointsFile}, [](const fs::path& from, const MapInfo&) {
          return std::make_shared<const SurfaceTexture>(read_texture(from));
        });
  return map;
}

std::vector<std::string> faults_of(const fs::path& folder) {
  std::vector<std::string> faults;
  const auto attempt = [&](const std::function<void()>& work) {
    try {
      work();
    } catch (const std::exception& error) {
      faults.emplace_back(error.what());
    }
  };
  std::optional<MapInfo> info;
  attempt([&] { info = read_info(folder); });
  if (!info) return faults;
  for (const auto& [name, file] : info->files) {
    const fs::path part = name;
    if (auto fault = fault_of(folder / part, file)) {
      faults.push_back(*fault);
      continue;
    }
    attempt([&, &name = name] {
      if (name == octree_file_of(*info)) static_cast<void>(read_octree(folder, *info));
      if (name == kMapMeshFile) static_cast<void>(read_mesh(folder / part));
      if (name == kMapKeyframesFile) static_cast<void>(read_keyframe_database(folder / part));
      if (name == kMapTrajectoryFile) static_cast<void>(read_trajectory(folder / part));
      if (name == kMapUnknownFile) static_cast<void>(read_unknown_surface(folder / part));
      if (name == kMapCoverageFile) static_cast<void>(read_picture(folder / part));
      if (name == kMapTexturePointsFile) static_cast<void>(read_texture(folder));
    });
  }
  attempt([&] {
    RevisionFiles files;
    for (const auto& [name, file] : info->files) files[name] = {file.bytes, file.sha256, ""};
    files[kMapInfoFile] = {};
    for (const std::string& fault : verify_visits(folder, files)) faults.push_back(fault);
  });
  return faults;
}

}  // namespace

std::string octree_checksum(const MapInfo& info) {
  const auto found = info.files.find(octree_file_of(info));
  return found == info.files.end() ? "" : found->second.sha256;
}

MapInfo load_map_info(const fs::path& folder) {
  return read_consistent(folder, [&] { return read_info(folder); });
}

SavedMap load_map(const fs::path& folder, KeyframeReading keyframes) {
  return read_consistent(folder, [&] {
    SavedMap map = read_map(folder);
    if (keyframes == KeyframeReading::kBefore) map.keyframe_database.load();
    return map;
  });
}

Mesh load_map_mesh(const fs::path& folder) {
  return read_consistent(folder, [&] {
    const MapInfo info = read_info(folder);
    require_sound(folder, info, kMapMeshFile);
    return read_mesh(folder / kMapMeshFile);
  });
}

StaticMap load_map_octree(const fs::path& folder) {
  return read_consistent(folder, [&] {
    const MapInfo info = read_info(folder);
    require_sound(folder, info, octree_file_of(info));
    return read_octree(folder, info);
  });
}

KeyframeDatabase load_map_keyframes(const fs::path& folder) {
  return read_consistent(folder, [&] {
    const MapInfo info = read_info(folder);
    require_sound(folder, info, kMapKeyframesFile);
    return read_keyframes(folder, info);
  });
}

std::shared_ptr<const SurfaceTexture> fitting_texture(const SavedMap& map) {
  const std::shared_ptr<const SurfaceTexture>& texture = map.texture.load();
  return texture && fits(*texture, map.mesh) ? texture : nullptr;
}

std::pair<Mesh, SurfaceTexture> load_textured_map_mesh(const fs::path& folder) {
  return read_consistent(folder, [&] {
    const MapInfo info = read_info(folder);
    require_sound(folder, info, kMapMeshFile);
    std::pair<Mesh, SurfaceTexture> both{read_mesh(folder / kMapMeshFile), {}};
    if (!has_texture(info)) return both;
    for (const char* name : {kMapTextureFile, kMapTexturePointsFile}) require_sound(folder, info, name);
    both.second = read_texture(folder);
    if (!fits(both.second, both.first)) fail(folder / kMapTexturePointsFile, "belongs to another mesh");
    return both;
  });
}

std::vector<std::string> verify_map(const fs::path& folder) {
  return read_consistent(folder, [&] { return faults_of(folder); });
}

}  // namespace roomradar
