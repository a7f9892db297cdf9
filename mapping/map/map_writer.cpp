// map_writer.cpp: writes the parts of a map, then map.json with their sizes and checksums.
#include "mapping/map/map_writer.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <system_error>
#include <vector>

#include "mapping/history/visits.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/map/map_history.hpp"
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

/// Returns the description of the map at `folder`; nullopt if there is none that can be read.
std::optional<MapInfo> present_info(const std::filesystem::path& folder) {
  std::error_code fault;
  if (!std::filesystem::exists(folder / kMapInfoFile, fault)) return std::nullopt;
  try {
    return load_map_info(folder);
  } catch (const Error&) {
    return std::nullopt;  // a damaged map has no revision that could be restored
  }
}

/// Returns a random UUID. With SOURCE_DATE_EPOCH set it follows from the time and the map's octree, so that a
/// map that is made again has the same bytes. Source: RFC 4122, version 4.
std::string new_map_id(const std::string& octree_sha256) {
  std::string seed = time_of_visit() + octree_sha256;
  std::random_device random;
  if (std::getenv("SOURCE_DATE_EPOCH") == nullptr)
    for (int i = 0; i < 8; ++i) seed += std::to_string(random());
  std::string id = sha256_of(seed).substr(0, 32);
  id[12] = '4';
  id[16] = "89ab"[static_cast<unsigned char>(id[16]) % 4];
  for (const std::size_t at : {20U, 16U, 12U, 8U}) id.insert(at, "-");
  return id;
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
  const VisitsLock lock(target_);
  const std::filesystem::path& path = begin();
  const std::optional<MapInfo> before = present_info(target_);
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
  const RevisionFiles replaced = before ? revision_files(target_, *before) : RevisionFiles();
  info.changed = time_of_visit();
  info.created = before ? before->created : info.changed;
  info.id = before && !before->id.empty() ? before->id : new_map_id(info.files.at(kMapOctreeFile).sha256);
  info.revision = before ? map_visits(target_).back().revision + 1 : 1;
  // The map was made from the one that it replaces, or is another scan in its place.
  info.parent_revision = before ? std::max(before->revision, 1) : 0;
  write_bytes(path / kMapInfoFile, to_json(info));
  VisitNote note = map.made;
  if (note.made_by.empty()) note.made_by = "saved";
  record_visit(target_, replaced, path, revision_files(path, info), note);

  partial_->commit();
}

}  // namespace roomradar
