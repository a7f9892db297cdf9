// tile_choice.hpp: chooses the tiles of a building that are loaded round the camera.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "mapping/building/building_info.hpp"

namespace roomradar {

struct TileChoiceConfig {
  double reach_m = 8.0;       ///< tiles nearer to the camera are chosen; depth cameras measure up to 8 m
  double keep_m = 2.0;        ///< a loaded tile stays chosen until it is this much farther away than reach_m
  double ahead_s = 2.0;       ///< the camera's position after this time counts as well as the present one
  bool has_unknown = true;    ///< tiles have their border of unknown space
  std::size_t max_bytes = 0;  ///< max memory of the chosen tiles, and of loading one of them; 0: no limit
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const TileChoiceConfig& config);

/// Returns the approximate memory of a tile in use, in bytes.
std::size_t tile_bytes(const BuildingTile& tile, bool has_unknown);
/// Returns the approximate memory that loading a tile takes in addition to tile_bytes(), in bytes.
std::size_t loading_bytes(const BuildingTile& tile, bool has_unknown);

/// Returns the distance (m) of a tile's surface from the camera, or from its position after ahead_s if that
/// is nearer. The distance is that of the surface's bounding box.
double tile_distance_m(const BuildingTile& tile, const Eigen::Vector3d& position_world,
                       const Eigen::Vector3d& velocity_world_mps, const TileChoiceConfig& config);

/// Returns the tiles whose surface may be in view: those whose bounding box at least 5 % of the rays from the
/// camera to the points enter, those with the most rays first. While one of them is not loaded, nothing is
/// known along these rays; see hide_behind().
std::vector<std::size_t> tiles_in_view(const BuildingInfo& building, const Eigen::Vector3d& position_world,
                                       std::span<const Eigen::Vector3d> points_world);

/// Returns the indices of the chosen tiles in `building.tiles`: those in view first, then nearest first.
/// Loaded tiles count as keep_m nearer than they are, so a camera that moves to and fro between two tiles
/// does not exchange them. With max_bytes, the list ends before the first tile that does not fit. It may then
/// be empty.
/// @param in_view    tiles that are chosen wherever the camera is
/// @param is_loaded  by tile
std::vector<std::size_t> choose_tiles(const BuildingInfo& building, const Eigen::Vector3d& position_world,
                                      const Eigen::Vector3d& velocity_world_mps,
                                      std::span<const std::size_t> in_view,
                                      const std::vector<bool>& is_loaded, const TileChoiceConfig& config);

}  // namespace roomradar
