// occupancy_cells.hpp: free, occupied and unknown space in coarse cells.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/octree/static_map.hpp"

namespace roomradar {

/// A grid of cells, aligned with the world frame's axes. All space outside the grid is unknown.
struct OccupancyCells {
  double cell_m = 0.0;                              ///< edge of a cell
  Eigen::Vector3i first = Eigen::Vector3i::Zero();  ///< the grid's lowest cell; cell 0 begins at the origin
  Eigen::Vector3i size = Eigen::Vector3i::Zero();   ///< number of cells along each axis
  std::vector<Occupancy> cells;                     ///< by index(); x runs fastest
  Eigen::AlignedBox3d occupied_world;               ///< bounds of all occupied space; may be empty

  // In the functions below, `cell` is relative to `first`.
  [[nodiscard]] bool contains(const Eigen::Vector3i& cell) const {
    return (cell.array() >= 0).all() && (cell.array() < size.array()).all();
  }
  [[nodiscard]] std::size_t index(const Eigen::Vector3i& cell) const {
    return (static_cast<std::size_t>(cell.z()) * static_cast<std::size_t>(size.y()) +
            static_cast<std::size_t>(cell.y())) *
               static_cast<std::size_t>(size.x()) +
           static_cast<std::size_t>(cell.x());
  }
  [[nodiscard]] Occupancy at(const Eigen::Vector3i& cell) const {
    return contains(cell) ? cells[index(cell)] : Occupancy::kUnknown;
  }
  [[nodiscard]] Eigen::Vector3d centre_world(const Eigen::Vector3i& cell) const {
    return ((first + cell).cast<double>().array() + 0.5).matrix() * cell_m;
  }
  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3d& p_world) const {
    return (p_world / cell_m).array().floor().cast<int>().matrix() - first;
  }
};

/// Resamples an octree to coarse cells. A cell is occupied if any of its voxels is occupied, else free if at
/// least half of its volume is free. Returns an empty grid for an empty map.
/// @param cell_m  edge of a cell, m; rounded to a multiple of the map's resolution, and enlarged if there
///                would be more than 16 million cells
OccupancyCells occupancy_cells(const StaticMap& map, double cell_m);

}  // namespace roomradar
