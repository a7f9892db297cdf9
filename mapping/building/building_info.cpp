// building_info.cpp: building.json and the meshes of tiles.
#include "mapping/building/building_info.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "mapping/mesh/mesh_file.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kFormat = 1;
constexpr std::string_view kMeshMagic = "RRTILEMS";
constexpr std::uint32_t kMeshVersion = 1;

json to_json(const ContentFile& file) {
  return {{"file", file.name}, {"sha256", file.sha256}, {"bytes", file.bytes}};
}

json array_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

ContentFile content_file_of(const json& value) {
  ContentFile file{value.at("file").get<std::string>(), value.at("sha256").get<std::string>(),
                   value.at("bytes").get<std::uintmax_t>()};
  const fs::path path = file.name;
  const bool is_inside =
      path.is_relative() &&
      std::none_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
  if (!is_inside || file.name.empty()) throw Error("names a file outside its folder: '" + file.name + "'");
  const bool is_hash =
      file.sha256.size() == 64 && file.sha256.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!is_hash) throw Error("has no SHA-256 of " + file.name);
  return file;
}

Eigen::Vector3d vector_of(const json& value) {
  const Eigen::Vector3d v(value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>());
  if (!v.allFinite()) throw Error("has a coordinate that is not a number");
  return v;
}

BuildingTile tile_of(const json& value) {
  BuildingTile tile;
  tile.index = tile_of_name(value.at("name").get<std::string>());
  tile.triangles = value.at("triangles").get<std::int64_t>();
  tile.surface_world = {vector_of(value.at("surface_min_m")), vector_of(value.at("surface_max_m"))};
  tile.mesh_origin = vector_of(value.at("mesh_origin_m"));
  tile.octree = content_file_of(value.at("octree"));
  tile.mesh = content_file_of(value.at("mesh"));
  tile.glb = content_file_of(value.at("glb"));
  if (value.contains("unknown")) tile.unknown = content_file_of(value.at("unknown"));
  return tile;
}

json to_json(const LookAlike& look_alike) {
  const Eigen::Quaterniond q(look_alike.T_other_this.linear());
  return {{"camera_position_m", array_of(look_alike.p_world)},
          {"other_translation_m", array_of(look_alike.T_other_this.translation())},
          {"other_rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

LookAlike look_alike_of(const json& value) {
  LookAlike look_alike;
  look_alike.p_world = vector_of(value.at("camera_position_m"));
  const json& xyzw = value.at("other_rotation_xyzw");
  const Eigen::Quaterniond q(xyzw.at(3).get<double>(), xyzw.at(0).get<double>(), xyzw.at(1).get<double>(),
                             xyzw.at(2).get<double>());
  if (!(std::abs(q.norm() - 1.0) < 1e-6)) throw Error("has a rotation that is not a unit quaternion");
  look_alike.T_other_this.linear() = q.normalized().toRotationMatrix();
  look_alike.T_other_this.translation() = vector_of(value.at("other_translation_m"));
  return look_alike;
}

BuildingInfo info_of(const json& value) {
  const int format = value.at("format").get<int>();
  if (format != kFormat)
    throw Error("is of format " + std::to_string(format) + "; this program reads format " +
                std::to_string(kFormat));
  BuildingInfo info;
  info.grid.resolution_m = value.at("resolution_m").get<double>();
  info.grid.edge_voxels = value.at("tile_edge_voxels").get<int>();
  require_valid(info.grid);
  for (const json& one : value.at("recordings")) {
    info.recordings.push_back(
        {one.at("name").get<std::string>(), one.at("source").get<std::string>(),
         one.at("frames_read").get<std::int64_t>(), one.at("frames_tracked").get<std::int64_t>(),
         one.at("keyframes").get<std::int64_t>(), one.at("frames_placed").get<std::int64_t>()});
    if (one.contains("keyframe_file"))
      info.recordings.back().keyframe_file = content_file_of(one.at("keyframe_file"));
  }
  for (const json& one : value.at("tiles")) info.tiles.push_back(tile_of(one));
  if (value.contains("look_alikes"))
    for (const json& one : value.at("look_alikes")) info.look_alikes.push_back(look_alike_of(one));
  const auto is_unordered = [](const BuildingTile& a, const BuildingTile& b) {
    return !is_before(a.index, b.index);
  };
  if (std::adjacent_find(info.tiles.begin(), info.tiles.end(), is_unordered) != info.tiles.end())
    throw Error("lists a tile twice, or tiles out of order");
  return info;
}

}  // namespace

std::vector<const ContentFile*> files_of(const BuildingTile& tile) {
  std::vector<const ContentFile*> files = {&tile.octree, &tile.mesh, &tile.glb};
  if (!tile.unknown.name.empty()) files.push_back(&tile.unknown);
  return files;
}

bool is_building(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / kBuildingFile, ignored);
}

BuildingInfo read_building(const fs::path& folder) {
  const fs::path path = folder / kBuildingFile;
  const std::string text = read_bytes(path, "a building's list of tiles");
  try {
    return info_of(json::parse(text));
  } catch (const json::exception& fault) {
    throw Error(path.string() + ": is damaged: " + fault.what());
  } catch (const Error& fault) {
    throw Error(path.string() + ": " + fault.what());
  }
}

void write_building(const BuildingInfo& info, const fs::path& folder) {
  json value = {{"format", kFormat},
                {"resolution_m", info.grid.resolution_m},
                {"tile_edge_voxels", info.grid.edge_voxels},
                {"recordings", json::array()},
                {"tiles", json::array()}};
  for (const BuildingRecording& one : info.recordings) {
    value["recordings"].push_back({{"name", one.name},
                                   {"source", one.source},
                                   {"frames_read", one.frames_read},
                                   {"frames_tracked", one.frames_tracked},
                                   {"keyframes", one.keyframes},
                                   {"frames_placed", one.frames_placed}});
    if (!one.keyframe_file.name.empty())
      value["recordings"].back()["keyframe_file"] = to_json(one.keyframe_file);
  }
  for (const BuildingTile& tile : info.tiles) {
    value["tiles"].push_back({{"name", name_of(tile.index)},
                              {"triangles", tile.triangles},
                              {"surface_min_m", array_of(tile.surface_world.min())},
                              {"surface_max_m", array_of(tile.surface_world.max())},
                              {"mesh_origin_m", array_of(tile.mesh_origin)},
                              {"octree", to_json(tile.octree)},
                              {"mesh", to_json(tile.mesh)},
                              {"glb", to_json(tile.glb)}});
    if (!tile.unknown.name.empty()) value["tiles"].back()["unknown"] = to_json(tile.unknown);
  }
  value["look_alikes"] = json::array();
  for (const LookAlike& one : info.look_alikes) value["look_alikes"].push_back(to_json(one));
  AtomicFile file(folder / kBuildingFile);
  file.stream() << value.dump(1) << "\n";
  file.commit();
}

void write_tile_mesh(const Mesh& mesh, const fs::path& path) {
  save_binary(path, kMeshMagic, kMeshVersion, mesh);
}

Mesh read_tile_mesh(const fs::path& path) {
  Mesh mesh;
  load_binary(path, kMeshMagic, kMeshVersion, mesh);
  const auto fail = [&](const char* fault) { throw Error(path.string() + ": is damaged: " + fault); };
  const auto is_one_each = [&](std::size_t count) { return count == 0 || count == mesh.vertices.size(); };
  if (!mesh.origin.allFinite() || !is_one_each(mesh.normals.size()) || !is_one_each(mesh.colours.size()))
    fail("normals, colours or origin are not those of a mesh");
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= mesh.vertices.size()) fail("a triangle names a vertex that is not there");
  for (const Eigen::Vector3f& v : mesh.vertices)
    if (!v.allFinite()) fail("a vertex is not a number");
  return mesh;
}

}  // namespace roomradar
