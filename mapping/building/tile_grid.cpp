// tile_grid.cpp: places and names of tiles, and the part of the surface in a tile's cube.
#include "mapping/building/tile_grid.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <set>
#include <tuple>

#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {

void require_valid(const TileGrid& grid) {
  const ConfigCheck rules{"tiles"};
  rules(grid.edge_voxels >= 64 && grid.edge_voxels <= 4096 &&
            std::has_single_bit(static_cast<unsigned>(grid.edge_voxels)),
        "edge_voxels", grid.edge_voxels, "a power of two from 64 to 4096");
  rules(grid.resolution_m >= 0.001 && grid.resolution_m <= 1.0, "resolution_m", grid.resolution_m,
        "within 0.001 and 1");
}

Eigen::AlignedBox3d box_of(const TileGrid& grid, const TileIndex& tile) {
  const auto corner = [&](const TileIndex& index) -> Eigen::Vector3d {
    return lowest_voxel(grid, index).cast<double>() * grid.resolution_m;
  };
  return {corner(tile), corner(tile + TileIndex::Ones())};
}

TileIndex tile_at(const TileGrid& grid, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d voxel =
      p_world / grid.resolution_m - lowest_voxel(grid, TileIndex::Zero()).cast<double>();
  return (voxel / grid.edge_voxels).array().floor().cast<int>();
}

bool is_before(const TileIndex& a, const TileIndex& b) {
  return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
}

namespace {

/// Set of tiles, in order.
class TileSet {
 public:
  explicit TileSet(const TileGrid& grid) : grid_(grid) {}
  /// Adds all tiles that have a voxel of a cube.
  void add(const VoxelIndex& lowest, int edge_voxels) {
    const VoxelIndex first = lowest - lowest_voxel(grid_, TileIndex::Zero());
    const auto tile = [&](int voxels) -> TileIndex {
      return (first.array() + voxels).unaryExpr([&](int v) { return floor_div(v, grid_.edge_voxels); });
    };
    const TileIndex low = tile(0), high = tile(edge_voxels - 1);
    if (low == high && low == last_) return;
    last_ = low;
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) tiles_.insert({x, y, z});
  }
  [[nodiscard]] std::vector<TileIndex> take() const { return {tiles_.begin(), tiles_.end()}; }

 private:
  const TileGrid& grid_;
  std::set<TileIndex, decltype(&is_before)> tiles_{&is_before};
  TileIndex last_ = TileIndex::Constant(INT_MAX);  // the last tile that was added alone
};

}  // namespace

std::vector<TileIndex> tiles_of(const StaticMap& map, const TileGrid& grid, int margin_voxels) {
  TileSet tiles(grid);
  VoxelIndex last_block = VoxelIndex::Constant(INT_MAX);
  map.visit_samples([&](const SurfaceSample& sample) {
    constexpr int kBlock = 4;  // the samples of a block come one after the other
    const VoxelIndex block = sample.voxel.unaryExpr([](int v) { return floor_div(v, kBlock); });
    if (block == last_block) return;
    last_block = block;
    tiles.add(kBlock * block - VoxelIndex::Constant(margin_voxels), kBlock + 2 * margin_voxels);
  });
  return tiles.take();
}

std::vector<TileIndex> observed_tiles(const StaticMap& map, const TileGrid& grid) {
  TileSet tiles(grid);
  map.visit_leaves([&](const MapLeaf& leaf) { tiles.add(leaf.lowest_voxel, leaf.edge_voxels); });
  return tiles.take();
}

std::string name_of(const TileIndex& tile) {
  return std::to_string(tile.x()) + "_" + std::to_string(tile.y()) + "_" + std::to_string(tile.z());
}

TileIndex tile_of_name(std::string_view name) {
  TileIndex tile;
  const char* at = name.data();
  const char* const end = at + name.size();
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0 && (at == end || *at++ != '_')) break;
    const auto [after, fault] = std::from_chars(at, end, tile[axis]);
    if (fault != std::errc{}) break;
    at = after;
    if (axis == 2 && at == end && name_of(tile) == name) return tile;
  }
  throw Error("'" + std::string(name) + "' is not a tile name; it must be three whole numbers, like 3_-1_0");
}

Mesh extract_tile_surface(const StaticMap& map, const TileGrid& grid, const TileIndex& tile,
                          const SurfaceConfig& config) {
  return extract_surface_part(map, box_of(grid, tile), config).mesh;
}

}  // namespace roomradar
