// map_writer.cpp: writes the parts of a map, then map.json with their sizes and checksums.
#include "mapping/map/map_writer.hpp"

#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/map/map_info.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/texture/surface_texture.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

void require_savable(const std::filesystem::path& target, const Mesh& mesh) {
  const auto fail = [&](const std::string& fault) { throw Error(target.string() + ": not saved: " + fault); };
  if (mesh.triangles.empty()) fail("the map has no surface; were there frames with depth and trusted poses?");
  if (mesh.triangles.size() > kMaxMeshTriangles || mesh.vertices.size() > 3 * kMaxMeshTriangles)
    fail("its surface has " + std::to_string(mesh.triangles.size()) + " triangles, and " +
         std::to_string(kMaxMeshTriangles) +
         " is the most; take a larger --deviation, or a coarser --resolution.");
}

/// Copies the objects that are kept in the room, if there are any.
void carry_objects(const std::filesystem::path& from, const std::filesystem::path& map) {
  std::error_code fault;
  if (from.empty() || !std::filesystem::is_directory(from, fault)) return;
  const std::filesystem::path to = map / kMapObjectsFolder;
  make_folder(to);
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(from, fault)) {
    if (!entry.is_regular_file(fault)) continue;
    const std::filesystem::path copy = to / entry.path().filename();
    std::filesystem::create_hard_link(entry.path(), copy, fault);  // files there are replaced, never changed
    if (!fault) continue;
    fault.clear();
    std::filesystem::copy_file(entry.path(), copy, fault);
    if (fault) throw Error(entry.path().string() + ": cannot be copied: " + system_reason(fault));
    sync_to_disk(copy);
  }
  if (fault) throw Error(from.string() + ": cannot be listed: " + system_reason(fault));
  sync_to_disk(to);
}

}  // namespace

void save_map(const std::filesystem::path& folder, const SavedMap& map) { MapWriter(folder).commit(map); }

MapWriter::MapWriter(const std::filesystem::path& folder) : target_(tidy_map_name(folder)) {}

const std::filesystem::path& MapWriter::begin() {
  require_replaceable(target_);
  if (!partial_) partial_.emplace(target_);
  return partial_->path();
}

LazyPart<KeyframeDatabase> MapWriter::write_keyframes(const KeyframeDatabase& keyframes) {
  write_keyframe_database(keyframes, begin() / kMapKeyframesFile);
  keyframes_ = keyframes.keyframes.size();
  return LazyPart<KeyframeDatabase>([folder = target_] { return load_map_keyframes(folder); });
}

LazyPart<StaticMap> MapWriter::write_octree(const StaticMap& octree, const Mesh& mesh) {
  require_savable(target_, mesh);
  const std::filesystem::path& path = begin();
  octree.write(path / kMapOctreeFile);
  resolution_m_ = octree.resolution_m();
  counts_ = octree.counts();
  write_unknown_surface(unknown_surface(octree, mesh), path / kMapUnknownFile);
  return LazyPart<StaticMap>([folder = target_] { return load_map_octree(folder); });
}

void MapWriter::commit(const SavedMap& map) {
  require_savable(target_, map.mesh);
  const std::filesystem::path& path = begin();
  if (!keyframes_) write_keyframes(map.keyframe_database.load());
  if (!resolution_m_) write_octree(map.octree.load(), map.mesh);
  write_mesh(map.mesh, path / kMapMeshFile);
  write_trajectory(path / kMapTrajectoryFile, map.trajectory);
  if (!map.coverage_png.empty())
    write_bytes(path / kMapCoverageFile, std::string(map.coverage_png.begin(), map.coverage_png.end()));

  const std::shared_ptr<const SurfaceTexture> texture = fitting_texture(map);
  if (texture) write_surface_texture(*texture, path / kMapTextureFile, path / kMapTexturePointsFile);

  carry_objects(map.objects_folder, path);

  MapInfo info = map.info;
  info.format_version = kMapFormatVersion;
  info.tool_version = kVersion;
  info.resolution_m = *resolution_m_;
  info.counts = counts_;
  info.vertices = map.mesh.vertices.size();
  info.triangles = map.mesh.triangles.size();
  info.keyframes = *keyframes_;
  info.poses = map.trajectory.size();
  info.files.clear();
  std::vector<std::string> parts(kMapParts.begin(), kMapParts.end());
  parts.emplace_back(kMapUnknownFile);
  if (!map.coverage_png.empty()) parts.emplace_back(kMapCoverageFile);
  if (texture) parts.insert(parts.end(), {kMapTextureFile, kMapTexturePointsFile});
  for (const std::string& part : parts)
    info.files[part] = {std::filesystem::file_size(path / part), sha256_of_file(path / part)};
  write_bytes(path / kMapInfoFile, to_json(info));

  partial_->commit();
}

}  // namespace roomradar
