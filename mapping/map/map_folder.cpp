// map_folder.cpp: saves, verifies, loads and exports a map.
#include "mapping/map/map_folder.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <optional>
#include <string_view>

#include "mapping/localization/keyframe_database_file.hpp"
#include "mapping/map/map_info_json.hpp"
#include "mapping/map/unknown_surface_file.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/octree/memory_use.hpp"
#include "mapping/storage/atomic_folder.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/pose_origin.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInfo = "map.json";
constexpr const char* kOctree = "octree.ot";
constexpr const char* kPlainOctree = "octree.bt";
constexpr const char* kMesh = "mesh.ply";
constexpr const char* kPlaces = "places.bin";
constexpr const char* kTrajectory = "trajectory.txt";
constexpr std::array<const char*, 5> kParts = {kOctree, kPlainOctree, kMesh, kPlaces, kTrajectory};
constexpr const char* kCoverage = "coverage.png";  // optional
constexpr const char* kUnknown = "unknown.bin";    // optional: earlier versions saved none
constexpr std::uintmax_t kMaxPictureBytes = 1U << 26U;
constexpr std::uintmax_t kMaxInfoBytes = 1U << 20U;

[[noreturn]] void fail(const fs::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

bool is_part(const std::string& name) {
  return name == kCoverage || name == kUnknown ||
         std::find(kParts.begin(), kParts.end(), name) != kParts.end();
}

// Throws Error unless `folder` is missing, empty, or contains a map and nothing else.
void require_replaceable(const fs::path& folder) {
  require_outside_maps(folder);
  std::error_code fault;
  const fs::file_status status = fs::symlink_status(folder, fault);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) fail(folder, "exists and is not a folder; choose another name for the map");
  bool empty = true;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    empty = false;
    const std::string name = entry.path().filename().string();
    if (name != kInfo && !is_part(name))
      fail(folder,
           "exists and holds \"" + name + "\", which is no part of a map; choose another name for the map");
  }
  if (fault) fail(folder, "cannot be listed: " + fault.message());
  if (!empty && !fs::exists(folder / kInfo))
    fail(folder,
         std::string("exists and has no ") + kInfo + ", so it is no map; choose another name for the map");
}

// Compares a file's size and checksum with map.json; returns the fault, or nullopt if they agree. Does not
// read a file that exceeds the machine's memory.
std::optional<std::string> fault_of(const fs::path& path, const MapFile& expected) {
  std::error_code fault;
  const fs::file_status status = fs::symlink_status(path, fault);
  if (!fs::exists(status)) return path.string() + ": is missing";
  if (!fs::is_regular_file(status)) return path.string() + ": is not a plain file";
  const std::uintmax_t bytes = fs::file_size(path, fault);
  if (fault) return path.string() + ": cannot be read: " + fault.message();
  if (bytes != expected.bytes)
    return path.string() + ": has " + std::to_string(bytes) + " bytes, and " + kInfo + " says " +
           std::to_string(expected.bytes) +
           (bytes < expected.bytes ? "; it is cut short" : "; it was altered");
  if (const std::uint64_t most = machine_bytes(); most > 0 && bytes > most)
    return path.string() + ": has " + std::to_string(bytes) + " bytes, and this machine's memory " +
           std::to_string(most) + "; it cannot be read here";
  try {
    if (sha256_of_file(path) != expected.sha256)
      return path.string() + ": was altered: its checksum is another";
  } catch (const Error& error) {
    return error.what();
  }
  return std::nullopt;
}

// Checks that map.json lists all required parts, optionally others of a map, and nothing else. Thus no listed
// path can lead out of the folder.
void require_parts(const MapInfo& info, const fs::path& where) {
  for (const char* part : kParts)
    if (!info.files.contains(part)) fail(where, std::string("does not list \"") + part + "\"");
  for (const auto& [name, file] : info.files)
    if (!is_part(name)) fail(where, "lists \"" + name.substr(0, 100) + "\", which is no part of a map");
}

std::vector<std::uint8_t> read_picture(const fs::path& path) {
  const std::string bytes = read_bytes(path, "a map's picture", kMaxPictureBytes);
  return {bytes.begin(), bytes.end()};
}

StaticMap read_octree(const fs::path& folder, const MapInfo& info) {
  StaticMap octree = StaticMap::read_ot(folder / kOctree);
  if (std::abs(octree.resolution_m() - info.resolution_m) > 1e-9 * info.resolution_m)
    fail(folder / kOctree, "its resolution is not the one in " + std::string(kInfo));
  return octree;
}

std::string in_megabytes(std::uint64_t bytes) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f MB", static_cast<double>(bytes) / 1e6);
  return text.data();
}

std::string extents(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return "nothing";
  const Eigen::Vector3d &low = box.min(), &high = box.max();
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "x %.2f..%.2f m, y %.2f..%.2f m, z %.2f..%.2f m", low.x(), high.x(),
                low.y(), high.y(), low.z(), high.z());
  return text.data();
}

}  // namespace

bool knows_recorded_world(const MapInfo& info) {
  const auto poses = info.settings.find(kPosesSetting);
  return (poses != info.settings.end() && poses->second == to_string(PoseOrigin::kRecorded)) ||
         !info.T_world_recorded.isApprox(Eigen::Isometry3d::Identity(), 1e-12);
}

SurfaceConfig surface_config_of(const MapInfo& info) {
  SurfaceConfig config;
  const auto said = info.settings.find(kDeviationSetting);
  if (said == info.settings.end()) return config;
  const char* const end = said->second.data() + said->second.size();
  const auto parsed = std::from_chars(said->second.data(), end, config.max_deviation_m);
  if (parsed.ec != std::errc() || parsed.ptr != end || !(config.max_deviation_m >= 0.0F) ||
      !std::isfinite(config.max_deviation_m))
    throw Error("map.json: settings: " + std::string(kDeviationSetting) + " is \"" +
                said->second.substr(0, 40) + "\"; must be metres, 0 or more");
  return config;
}

fs::path tidy_map_name(const fs::path& folder) {
  if (folder.empty()) throw Error("the map's folder has no name; give one, such as maps/kitchen");
  fs::path path = folder.lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // a trailing slash
  if (path.filename() == "." || path.filename() == ".." || !path.has_filename())
    fail(folder, "is no name for a map's folder; give a new one, such as maps/kitchen");
  return path;
}

void require_outside_maps(const fs::path& path) {
  if (path.empty()) return;
  std::error_code ignored;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (fs::exists(folder / kInfo, ignored))
    fail(path, "lies in the folder of a map, which holds nothing but the map; choose another place");
}

void require_contents_outside_maps(const fs::path& folder) {
  if (folder.empty()) return;
  require_outside_maps((folder / "").parent_path());
  require_outside_maps(folder / "contents");
}

void require_can_become_map(const fs::path& folder, std::initializer_list<fs::path> outputs) {
  const fs::path map = tidy_map_name(folder);
  require_replaceable(map);
  std::error_code ignored;  // paths that cannot be resolved are rejected when they are written
  const fs::path whole = fs::weakly_canonical(fs::absolute(map), ignored);
  for (const fs::path& output : outputs) {
    if (output.empty()) continue;
    const fs::path path = fs::weakly_canonical(fs::absolute(output), ignored);
    if (!whole.empty() &&
        std::mismatch(whole.begin(), whole.end(), path.begin(), path.end()).first == whole.end())
      fail(output, "would lie in " + map.string() +
                       ", which is to be a map and holds nothing but that; choose another place");
  }
}

void save_map(const fs::path& folder, const SavedMap& map) {
  const fs::path target = tidy_map_name(folder);
  require_replaceable(target);
  if (map.mesh.triangles.empty())
    fail(target, "not saved: the map has no surface; were there frames with depth and trusted poses?");
  if (map.mesh.triangles.size() > kMaxMeshTriangles || map.mesh.vertices.size() > 3 * kMaxMeshTriangles)
    fail(target, "not saved: its surface has " + std::to_string(map.mesh.triangles.size()) +
                     " triangles, and " + std::to_string(kMaxMeshTriangles) +
                     " is the most; take a larger --deviation, or a coarser --resolution.");
  AtomicFolder partial(target);

  map.octree.write_ot(partial.path() / kOctree);
  map.octree.write_bt(partial.path() / kPlainOctree);
  write_mesh(map.mesh, partial.path() / kMesh);
  write_keyframe_database(map.keyframe_database, partial.path() / kPlaces);
  write_trajectory(partial.path() / kTrajectory, map.trajectory);
  write_unknown_surface(unknown_surface(map.octree, map.mesh), partial.path() / kUnknown);
  if (!map.coverage_png.empty())
    write_bytes(partial.path() / kCoverage, std::string(map.coverage_png.begin(), map.coverage_png.end()));

  MapInfo info = map.info;
  info.format_version = kMapFormatVersion;
  info.tool_version = kVersion;
  info.resolution_m = map.octree.resolution_m();
  info.counts = map.octree.counts();
  info.vertices = map.mesh.vertices.size();
  info.triangles = map.mesh.triangles.size();
  info.keyframes = map.keyframe_database.keyframes.size();
  info.poses = map.trajectory.size();
  info.files.clear();
  std::vector<std::string> parts(kParts.begin(), kParts.end());
  parts.emplace_back(kUnknown);
  if (!map.coverage_png.empty()) parts.emplace_back(kCoverage);
  for (const std::string& part : parts)
    info.files[part] = {fs::file_size(partial.path() / part), sha256_of_file(partial.path() / part)};
  write_bytes(partial.path() / kInfo, to_json(info));

  partial.commit();
}

namespace {

MapInfo read_info(const fs::path& folder) {
  std::error_code fault;
  if (const fs::path aside = interrupted_replacement_of(folder); !aside.empty())
    fail(folder, "a save was killed while it took this map's place, and left it as " +
                     aside.filename().string() + "; rename that to " + folder.filename().string());
  if (!fs::is_directory(folder, fault))
    fail(folder, "there is no such map folder; make one with `roomradar prescan`");
  const fs::path path = folder / kInfo;
  const fs::file_status status = fs::symlink_status(path, fault);
  if (!fs::exists(status)) fail(path, "is missing, so the folder is no map");
  if (!fs::is_regular_file(status))
    fail(path, "is not a plain file, but a link or a folder; a map contains only plain files");
  MapInfo info = parse_map_info(read_bytes(path, "a map's description", kMaxInfoBytes), path.string());
  require_parts(info, path);
  return info;
}

SavedMap read_map(const fs::path& folder) {
  MapInfo info = read_info(folder);
  for (const auto& [name, file] : info.files)
    if (const auto fault = fault_of(folder / name, file))
      throw Error(*fault + "; take the map from a backup or scan the room again");
  return {.info = info,
          .octree = read_octree(folder, info),
          .mesh = read_mesh(folder / kMesh),
          .keyframe_database = read_keyframe_database(folder / kPlaces),
          .trajectory = read_trajectory(folder / kTrajectory),
          .coverage_png =
              info.files.contains(kCoverage) ? read_picture(folder / kCoverage) : std::vector<std::uint8_t>{},
          .unknown = info.files.contains(kUnknown)
                         ? std::make_shared<const UnknownSurface>(read_unknown_surface(folder / kUnknown))
                         : nullptr};
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
      if (name == kOctree) static_cast<void>(read_octree(folder, *info));
      if (name == kMesh) static_cast<void>(read_mesh(folder / part));
      if (name == kPlaces) static_cast<void>(read_keyframe_database(folder / part));
      if (name == kTrajectory) static_cast<void>(read_trajectory(folder / part));
      if (name == kUnknown) static_cast<void>(read_unknown_surface(folder / part));
      if (name == kCoverage) static_cast<void>(read_picture(folder / part));
    });
  }
  return faults;
}

}  // namespace

MapInfo load_map_info(const fs::path& folder) {
  return read_consistent(folder, [&] { return read_info(folder); });
}

SavedMap load_map(const fs::path& folder) {
  return read_consistent(folder, [&] { return read_map(folder); });
}

std::vector<std::string> verify_map(const fs::path& folder) {
  return read_consistent(folder, [&] { return faults_of(folder); });
}

void export_map(const fs::path& folder, const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool octree = extension == ".ot" || extension == ".bt";
  if (!octree && extension != ".ply" && extension != ".obj" && extension != ".stl" && extension != ".glb")
    fail(path, "the extension \"" + extension +
                   "\" is no format to export to; use .ot or .bt for the octree, .ply .obj .stl or .glb for "
                   "the mesh");
  require_outside_maps(path);
  const char* part = extension == ".ot" ? kOctree : extension == ".bt" ? kPlainOctree : kMesh;
  read_consistent(folder, [&] {
    const MapInfo info = read_info(folder);
    if (const auto fault = fault_of(folder / part, info.files.at(part))) throw Error(*fault);
    if (!octree) {
      write_mesh(read_mesh(folder / part), path);
      return 0;
    }
    std::ifstream in(folder / part, std::ios::binary);
    AtomicFile out(path);
    require_written(out.stream() << in.rdbuf(), path);
    out.commit();
    return 0;
  });
}

std::string describe(const MapInfo& info) {
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    text += std::string(name) + std::string(16 - std::string_view(name).size(), ' ') + value + "\n";
  };
  std::array<char, 32> resolution{};
  std::snprintf(resolution.data(), resolution.size(), "%g m", info.resolution_m);
  line("source", info.source);
  line("resolution", resolution.data());
  line("frames",
       std::to_string(info.frames_fused) + " fused of " + std::to_string(info.frames_read) + " read");
  line("up", info.up_source);
  line("octree", std::to_string(info.counts.occupied_leaves) + " occupied and " +
                     std::to_string(info.counts.free_leaves) + " free leaves, " +
                     std::to_string(info.counts.nodes) + " nodes, " + in_megabytes(info.counts.memory_bytes) +
                     " in memory");
  line("known", extents(info.counts.known_world));
  line("occupied", extents(info.counts.occupied_world));
  line("mesh", std::to_string(info.triangles) + " triangles, " + std::to_string(info.vertices) + " vertices");
  line("database", std::to_string(info.keyframes) + " keyframes");
  line("trajectory", std::to_string(info.poses) + " poses");
  for (const auto& [name, file] : info.files) line(name.c_str(), in_megabytes(file.bytes));
  for (const auto& [name, value] : info.settings) line(name.substr(0, 15).c_str(), value);
  line("format", std::to_string(info.format_version) + ", by roomradar " + info.tool_version);
  return text;
}

}  // namespace roomradar
