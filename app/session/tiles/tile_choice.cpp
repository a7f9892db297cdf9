// tile_choice.cpp: distances of tiles, and their memory.
#include "app/session/tiles/tile_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/session/tiles/unloaded_space.hpp"
#include "mapping/types/system/config_check.hpp"

namespace roomradar {
namespace {

// Measured with tiles of 10,000 to 330,000 triangles.
constexpr double kTriangleBytes = 120.0;        // tree, renderer's copy, the rasteriser's pieces
constexpr double kUnknownTriangleBytes = 15.0;  // border of unknown space, per triangle of the surface
constexpr double kUnknownGridBytes = 3e6;
constexpr double kUnknownLoadingBytes = 4e6;
constexpr double kMeshExpansion =
    3.0;  // mesh, its file and its tree while they are made, per byte of the file

/// Returns the distance (m) of the bounding box of a tile's surface from the camera, or from the camera's
/// position after ahead_s, whichever is less.
double tile_distance_m(const BuildingTile& tile, const Eigen::Vector3d& position_world,
                       const Eigen::Vector3d& velocity_world_mps, const TileChoiceConfig& config) {
  const Eigen::Vector3d ahead_world = position_world + config.ahead_s * velocity_world_mps;
  return std::min(tile.surface_world.exteriorDistance(position_world),
                  tile.surface_world.exteriorDistance(ahead_world));
}

}  // namespace

void require_valid(const TileChoiceConfig& config) {
  const ConfigCheck require{"tiles"};
  require(config.reach_m > 0.0 && config.reach_m <= 100.0, "reach_m", config.reach_m, "in 0..100 m");
  require(config.keep_m >= 0.0 && config.keep_m <= 100.0, "keep_m", config.keep_m, "in 0..100 m");
  require(config.ahead_s >= 0.0 && config.ahead_s <= 60.0, "ahead_s", config.ahead_s, "in 0..60 s");
}

std::size_t tile_bytes(const BuildingTile& tile, bool has_unknown) {
  const auto triangles = static_cast<double>(std::max<std::int64_t>(tile.triangles, 0));
  const double unknown = has_unknown ? triangles * kUnknownTriangleBytes + kUnknownGridBytes : 0.0;
  return static_cast<std::size_t>(triangles * kTriangleBytes + unknown);
}

std::size_t loading_bytes(const BuildingTile& tile, bool has_unknown) {
  const double unknown = has_unknown ? kUnknownLoadingBytes : 0.0;
  return static_cast<std::size_t>(kMeshExpansion * static_cast<double>(tile.mesh.bytes) + unknown);
}

std::vector<std::size_t> tiles_in_view(const BuildingInfo& building, const Eigen::Vector3d& position_world,
                                       std::span<const Eigen::Vector3d> points_world) {
  constexpr double kMinPart = 0.05;
  constexpr double kReach = 1.05;  // of a ray, relative to its point: depth and poses have errors
  std::vector<std::pair<int, std::size_t>> entered;
  for (std::size_t i = 0; i < building.tiles.size(); ++i) {
    const Eigen::AlignedBox3d& box = building.tiles[i].surface_world;
    const auto rays = static_cast<int>(
        std::count_if(points_world.begin(), points_world.end(), [&](const Eigen::Vector3d& p_world) {
          return ray_entry(box, position_world, p_world - position_world) <= kReach;
        }));
    if (rays > 0 && rays >= kMinPart * static_cast<double>(points_world.size()))
      entered.emplace_back(-rays, i);
  }
  std::sort(entered.begin(), entered.end());
  std::vector<std::size_t> tiles;
  for (const auto& [negative, i] : entered) tiles.push_back(i);
  return tiles;
}

std::vector<std::size_t> choose_tiles(const BuildingInfo& building, const Eigen::Vector3d& position_world,
                                      const Eigen::Vector3d& velocity_world_mps,
                                      std::span<const std::size_t> in_view,
                                      const std::vector<bool>& is_loaded, const TileChoiceConfig& config) {
  constexpr double kInView_m = -1e6;  // nearer than all others
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < building.tiles.size(); ++i) {
    double distance_m = tile_distance_m(building.tiles[i], position_world, velocity_world_mps, config);
    if (is_loaded[i]) distance_m -= config.keep_m;
    const auto seen = std::find(in_view.begin(), in_view.end(), i);
    if (seen != in_view.end()) distance_m = kInView_m + static_cast<double>(seen - in_view.begin());
    if (distance_m < config.reach_m) near.emplace_back(distance_m, i);
  }
  std::sort(near.begin(), near.end());
  std::vector<std::size_t> chosen;
  std::size_t used_bytes = 0, most_loading_bytes = 0;
  for (const auto& [distance_m, i] : near) {
    const BuildingTile& tile = building.tiles[i];
    used_bytes += tile_bytes(tile, config.has_unknown);
    if (!is_loaded[i])
      most_loading_bytes = std::max(most_loading_bytes, loading_bytes(tile, config.has_unknown));
    if (config.max_bytes > 0 && used_bytes + most_loading_bytes > config.max_bytes) break;
    chosen.push_back(i);
  }
  return chosen;
}

}  // namespace roomradar
