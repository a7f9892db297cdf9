// exploration_grid.hpp: coarse grid of free, occupied and unknown space around the camera of a running scan.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mapping/alignment/packed_view.hpp"
#include "mapping/coverage/occupancy_cells.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

enum class CellState : std::uint8_t {
  kUnknown,
  kFree,
  kOccupied,
  kUnmeasurable,  ///< unknown although repeatedly observed at short range, such as glass or dark surfaces
};

/// Box of cells of 10 cm, 25.6 x 25.6 m wide and 9.6 m high, centred at the camera position. +z of the world
/// frame is up. Takes 6 MB.
class ExplorationGrid {
 public:
  static constexpr double kCell_m = 0.1;

  explicit ExplorationGrid(const Eigen::Vector3d& centre_world);

  /// Marks the cells along each ray of a keyframe as free, and the cell at the ray's end as occupied. Rays
  /// are those of every 8th pixel in both directions of an image of 320 x 240, up to 5 m.
  void add(const StoredView& view, const Eigen::Isometry3d& T_world_camera);

  /// Returns the state of the cell that contains a point; kUnmeasurable outside the grid.
  [[nodiscard]] CellState at(const Eigen::Vector3d& p_world) const;

  /// Returns the cells inside the bounding box of all cells that rays crossed. Unmeasurable cells count as
  /// occupied, since further scanning cannot observe them.
  [[nodiscard]] OccupancyCells occupancy() const;

 private:
  Eigen::Vector3i first_;       ///< indices of the lowest cell; cell (0, 0, 0) begins at the world origin
  Eigen::AlignedBox3i marked_;  ///< cells that rays crossed
  /// Bit 0: a ray has crossed the cell. Bit 1: a ray has ended in it. Bits 2 to 7: number of rays without
  /// depth, at most 63.
  std::vector<std::uint8_t> cells_;

  // Cells are counted from first_; index -1: outside the grid.
  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3d& p_world) const;
  [[nodiscard]] static std::int64_t index_of(const Eigen::Vector3i& cell);
  [[nodiscard]] CellState state_of(std::int64_t index) const;
};

/// Returns the fraction of a frame's tested pixels whose points are in cells surrounded by free cells. Such
/// points are on moving objects. Tests every 8th pixel in both directions, up to 4 m.
double moved_fraction(const ExplorationGrid& grid, const Frame& frame,
                      const Eigen::Isometry3d& T_world_camera);

/// Returns a grid centred at a camera, filled from at most 200 keyframes, those nearest to the camera.
/// @param T_grid_world  transforms points from the keyframes' world frame, which is that of camera_world, to
///                      the grid's
ExplorationGrid explored_around(const Eigen::Vector3d& camera_world, const std::vector<Keyframe>& keyframes,
                                const Eigen::Isometry3d& T_grid_world = Eigen::Isometry3d::Identity());

}  // namespace roomradar
