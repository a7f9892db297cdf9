// tile_loading.cpp: the files of a tile, and the open faces of its border of unknown space.
#include "app/session/tiles/tile_loading.hpp"

#include <algorithm>

#include "mapping/map/unknown_surface_file.hpp"

namespace roomradar {
namespace {

bool is_listed(const BuildingInfo& building, const TileIndex& index) {
  const auto found = std::lower_bound(
      building.tiles.begin(), building.tiles.end(), index,
      [](const BuildingTile& tile, const TileIndex& of) { return is_before(tile.index, of); });
  return found != building.tiles.end() && found->index == index;
}

/// Removes the triangles on and beyond those faces of the cube that have a tile behind them.
/// @param cell_m  edge of the cells whose faces form the border
void open_faces(const BuildingInfo& building, const TileIndex& index, double cell_m, Mesh& border) {
  const Eigen::AlignedBox3d cube = box_of(building.grid, index);
  const double slack_m = 0.25 * cell_m;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      if (!is_listed(building, index + side * TileIndex::Unit(axis))) continue;
      const double face_m = (side < 0 ? cube.min() : cube.max())[axis] - border.origin[axis];
      const auto is_beyond = [&](std::uint32_t v) {
        return side * (static_cast<double>(border.vertices[v][axis]) - face_m) > -slack_m;
      };
      std::erase_if(border.triangles,
                    [&](const Triangle& t) { return is_beyond(t[0]) && is_beyond(t[1]) && is_beyond(t[2]); });
    }
}

}  // namespace

LoadedTile load_tile(const BuildingInfo& building, const std::filesystem::path& folder, std::size_t tile,
                     bool has_unknown) {
  const BuildingTile& listed = building.tiles.at(tile);
  LoadedTile loaded;
  loaded.mesh = read_tile_mesh(folder / listed.mesh.name);
  loaded.mesh.normals = {};
  loaded.mesh.colours = {};
  if (has_unknown) {
    loaded.unknown = read_unknown_surface(folder / listed.unknown.name);
    Mesh& border = loaded.unknown.mesh_world;
    open_faces(building, listed.index, loaded.unknown.grid.cell_m, border);
    loaded.unknown_tree.build_by_place(border);
    border = {};
  }
  loaded.tree.build_by_place(loaded.mesh);
  cut_into_pieces(loaded.tree.vertices(), loaded.tree.triangles(), loaded.pieces);
  loaded.pieces.chunked = {};
  loaded.pieces.places = {};
  return loaded;
}

}  // namespace roomradar
