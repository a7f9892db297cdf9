// tileset.cpp: writes a bounding volume hierarchy over the tiles' cubes.
#include "app/building/tileset.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "mapping/types/system/atomic_file.hpp"

namespace roomradar {
namespace {

using nlohmann::json;

/// A node of the tileset, with the box of all surface below it.
struct Node {
  json value;
  Eigen::AlignedBox3d box;
};

/// `boundingVolume.box` of 3D Tiles: the centre and three half axes.
json box_json(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d middle = box.center(), half = (0.5 * box.sizes()).cwiseMax(1e-3);
  return {{"box",
           {middle.x(), middle.y(), middle.z(), half.x(), 0.0, 0.0, 0.0, half.y(), 0.0, 0.0, 0.0, half.z()}}};
}

Node leaf_of(const BuildingTile& tile) {
  const Eigen::Vector3d& t = tile.mesh_origin;
  // Column by column. The file has y up, as glTF requires; viewers turn it to z up.
  const json transform = {1.0, 0.0, 0.0, 0.0, 0.0,   1.0,   0.0,   0.0,
                          0.0, 0.0, 1.0, 0.0, t.x(), t.y(), t.z(), 1.0};
  const Eigen::AlignedBox3d own(tile.surface_world.min() - t, tile.surface_world.max() - t);
  return {{{"boundingVolume", box_json(own)},
           {"geometricError", 0.0},
           {"transform", transform},
           {"content", {{"uri", tile.glb.name}}},
           {"extras", {{"tile", name_of(tile.index)}}}},
          tile.surface_world};
}

}  // namespace

std::string tileset_text(const BuildingInfo& info) {
  std::map<TileIndex, Node, decltype(&is_before)> level(&is_before);
  TileIndex lowest = TileIndex::Zero();  // indices from 0 on, which meet in one node when halved
  for (const BuildingTile& tile : info.tiles) lowest = lowest.cwiseMin(tile.index);
  for (const BuildingTile& tile : info.tiles) level.emplace(tile.index - lowest, leaf_of(tile));
  double edge = edge_m(info.grid);
  while (level.size() > 1) {
    std::map<TileIndex, Node, decltype(&is_before)> above(&is_before);
    for (auto& [index, node] : level) {
      const TileIndex parent = index / 2;
      auto [at, is_new] = above.emplace(parent, Node{});
      if (is_new) at->second.value["children"] = json::array();
      at->second.value["children"].push_back(std::move(node.value));
      at->second.box.extend(node.box);
    }
    // A viewer that leaves out what is below misses surface as large as a tile.
    for (auto& [index, node] : above) {
      node.value["boundingVolume"] = box_json(node.box);
      node.value["geometricError"] = edge;
    }
    edge *= 2.0;
    level = std::move(above);
  }
  json tileset = {{"asset", {{"version", "1.1"}, {"generator", "roomradar"}}}, {"geometricError", edge}};
  if (level.empty())
    tileset["root"] = {{"boundingVolume", box_json(Eigen::AlignedBox3d(Eigen::Vector3d::Zero()))},
                       {"geometricError", 0.0},
                       {"refine", "ADD"}};
  else
    tileset["root"] = std::move(level.begin()->second.value);
  tileset["root"]["refine"] = "ADD";
  return tileset.dump(1) + "\n";
}

void write_tileset(const BuildingInfo& info, const std::filesystem::path& folder) {
  AtomicFile file(folder / kTilesetFile);
  file.stream() << tileset_text(info);
  file.commit();
}

}  // namespace roomradar
