// building_map.cpp: reads tile by tile, and adds each to the whole.
#include "mapping/building/building_map.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <limits>
#include <string>
#include <unordered_map>

#include "mapping/alignment/keyframe.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/types/fibonacci_hash.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// A position in the world, bit for bit.
using Position = std::array<std::uint64_t, 3>;

struct PositionHash {
  std::size_t operator()(const Position& p) const {
    std::uint64_t hash = 0;
    for (const std::uint64_t part : p) hash = fibonacci_hash(hash ^ part);
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

Position position_of(const Eigen::Vector3d& p_world) {
  return {std::bit_cast<std::uint64_t>(p_world.x() + 0.0), std::bit_cast<std::uint64_t>(p_world.y() + 0.0),
          std::bit_cast<std::uint64_t>(p_world.z() + 0.0)};  // + 0.0: -0 equals 0
}

using VertexAt = std::unordered_map<Position, std::uint32_t, PositionHash>;

void add_tile(const Mesh& tile, VertexAt& vertex_at, Mesh& whole) {
  std::vector<std::uint32_t> index_in_whole(tile.vertices.size());
  const auto first_own = static_cast<std::uint32_t>(whole.vertices.size());
  for (std::size_t i = 0; i < tile.vertices.size(); ++i) {
    const Eigen::Vector3d p_world = tile.origin + tile.vertices[i].cast<double>();
    const auto [at, is_new] =
        vertex_at.try_emplace(position_of(p_world), static_cast<std::uint32_t>(whole.vertices.size()));
    index_in_whole[i] = at->second;
    if (!is_new && at->second < first_own) continue;
    // Two vertices of one tile at the same position stay two.
    index_in_whole[i] = static_cast<std::uint32_t>(whole.vertices.size());
    whole.vertices.emplace_back((p_world - whole.origin).cast<float>());
    if (!tile.normals.empty()) whole.normals.push_back(tile.normals[i]);
    if (!tile.colours.empty()) whole.colours.push_back(tile.colours[i]);
  }
  for (const Triangle& t : tile.triangles)
    whole.triangles.push_back({index_in_whole[t[0]], index_in_whole[t[1]], index_in_whole[t[2]]});
}

/// Returns the memory of a keyframe with its share of the index, in bytes. A frame of 640 x 480 pixels with
/// 800 features has 112,000.
std::size_t keyframe_bytes(const MapKeyframe& keyframe) {
  constexpr std::size_t kIndexed = 128;  // bytes per indexed descriptor: 16 tables of 8 bytes
  return sizeof(MapKeyframe) + keyframe.descriptors.size() * sizeof(Descriptor) +
         keyframe.points_camera.size() * sizeof(Eigen::Vector3f) +
         keyframe.preview_depth_mm.pixels.size() * sizeof(std::uint16_t) +
         std::min(keyframe.descriptors.size(), FeatureIndex::kIndexedFeatures) * kIndexed;
}

}  // namespace

Mesh load_building_mesh(const BuildingInfo& info, const fs::path& folder) {
  Mesh whole;
  VertexAt vertex_at;
  bool have_normals = true, have_colours = true;
  for (const BuildingTile& tile : info.tiles) {
    const Mesh mesh = read_tile_mesh(folder / tile.mesh.name);
    if (whole.vertices.empty()) whole.origin = mesh.origin;
    if (whole.vertices.size() + mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max())
      throw Error(folder.string() + ": has too many vertices for one mesh; export single tiles instead");
    have_normals = have_normals && !mesh.normals.empty();
    have_colours = have_colours && !mesh.colours.empty();
    add_tile(mesh, vertex_at, whole);
  }
  if (!have_normals) whole.normals.clear();
  if (!have_colours) whole.colours.clear();
  return whole;
}

StaticMap load_building_octree(const BuildingInfo& info, const fs::path& folder) {
  StaticMap whole(info.grid.resolution_m);
  for (const BuildingTile& tile : info.tiles)
    whole.add_evidence(StaticMap::read(folder / tile.octree.name, whole.config()));
  return whole;
}

std::vector<std::size_t> distinct_views(std::span<const MapKeyframe> keyframes, double min_step) {
  std::vector<std::size_t> distinct;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const auto step = [&] {
      return view_distance(keyframes[distinct.back()].T_world_camera.inverse() * keyframes[i].T_world_camera);
    };
    if (distinct.empty() || !(step() < min_step)) distinct.push_back(i);
  }
  return distinct;
}

namespace {

/// Drops patches and spare memory.
void reduce(MapKeyframe& keyframe) {
  keyframe.patches = std::vector<SurfacePatch>();  // "= {}" would keep the memory
  keyframe.descriptors.shrink_to_fit();
  keyframe.points_camera.shrink_to_fit();
}

std::size_t bytes_of(const std::vector<MapKeyframe>& keyframes) {
  std::size_t bytes = 0;
  for (const MapKeyframe& keyframe : keyframes) bytes += keyframe_bytes(keyframe);
  return bytes;
}

/// Leaves out keyframes with similar views, until the rest has at most max_bytes.
void thin_out(std::vector<MapKeyframe>& keyframes, std::size_t max_bytes) {
  for (double step = 0.05; keyframes.size() > 1 && bytes_of(keyframes) > max_bytes; step *= 1.25) {
    std::vector<MapKeyframe> kept;
    for (const std::size_t i : distinct_views(keyframes, step)) kept.push_back(std::move(keyframes[i]));
    keyframes = std::move(kept);
  }
}

}  // namespace

KeyframeDatabase load_building_keyframes(const BuildingInfo& info, const fs::path& folder,
                                         std::size_t max_bytes) {
  KeyframeDatabase whole;
  double file_bytes = 0.0;
  for (const BuildingRecording& recording : info.recordings)
    file_bytes += static_cast<double>(recording.keyframe_file.bytes);
  for (const BuildingRecording& recording : info.recordings) {
    if (recording.keyframe_file.name.empty()) continue;
    std::vector<MapKeyframe> own = read_keyframe_database(folder / recording.keyframe_file.name).keyframes;
    for (MapKeyframe& keyframe : own) reduce(keyframe);
    if (max_bytes > 0)
      thin_out(own,
               static_cast<std::size_t>(static_cast<double>(max_bytes) *
                                        static_cast<double>(recording.keyframe_file.bytes) / file_bytes));
    whole.keyframes.insert(whole.keyframes.end(), std::make_move_iterator(own.begin()),
                           std::make_move_iterator(own.end()));
  }
  if (whole.keyframes.empty())
    throw Error(folder.string() +
                ": has no keyframes; run `roomradar building` again with the same recordings");
  whole.look_alikes = info.look_alikes;
  update_index(whole);
  return whole;
}

}  // namespace roomradar
