// tile_choice.hpp: chooses the tiles of a building (cubes of its map, see tile_grid.hpp) to load around the
// camera.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "mapping/building/building_info.hpp"

namespace roomradar {

struct TileChoiceConfig {
  double reach_m = 8.0;       ///< max distance from the camera; depth cameras measure up to 8 m
  double keep_m = 2.0;        ///< hysteresis: loaded tiles may be this much farther than reach_m
  double ahead_s = 2.0;       ///< distances are also measured from the position predicted for this time
  bool has_unknown = true;    ///< tiles include their frontier of unknown space
  std::size_t max_bytes = 0;  ///< max memory of the chosen tiles and of loading one; 0: no limit
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const TileChoiceConfig& config);

/// Settings of TileWindow.
struct TileWindowConfig {
  std::filesystem::path folder;  ///< the building's folder
  BuildingInfo building;
  TileChoiceConfig choice;
  /// Max memory of the process, bytes; 0: no limit. The choice of tiles keeps to it where possible.
  std::size_t max_process_bytes = 0;
  /// Time from the request for a tile to the first frame that uses it, s. A tile in view is used as soon as
  /// it is loaded.
  double apply_after_s = 0.5;
  /// true: the frame in which a tile is due waits for the worker thread, so results are reproducible.
  /// false: frames do not wait, and a tile is used as soon as it is loaded.
  bool wait = true;
};

/// Returns the approximate memory of a tile in use, in bytes.
std::size_t tile_bytes(const BuildingTile& tile, bool has_unknown);
/// Returns the approximate memory that loading a tile takes in addition to tile_bytes(), in bytes.
std::size_t loading_bytes(const BuildingTile& tile, bool has_unknown);

/// Returns the tiles whose surface may be in view: at least 5 % of the rays from the camera to the points
/// enter the surface's bounding box. Tiles with the most such rays are first. The depth along these rays is
/// unknown until the tile is loaded; see hide_behind().
std::vector<std::size_t> tiles_in_view(const BuildingInfo& building, const Eigen::Vector3d& position_world,
                                       std::span<const Eigen::Vector3d> points_world);

/// Returns the indices of the chosen tiles in `building.tiles`: those in view first, then nearest first.
/// Loaded tiles count as keep_m nearer, so a camera that moves back and forth between two tiles does not swap
/// them. With max_bytes, the list ends before the first tile that does not fit, and may be empty.
/// @param in_view    tiles to choose at any distance
/// @param is_loaded  one per tile of the building
std::vector<std::size_t> choose_tiles(const BuildingInfo& building, const Eigen::Vector3d& position_world,
                                      const Eigen::Vector3d& velocity_world_mps,
                                      std::span<const std::size_t> in_view,
                                      const std::vector<bool>& is_loaded, const TileChoiceConfig& config);

}  // namespace roomradar
