// sparse_bit_grid.hpp: a 3D grid of bits, of which few are set, in the words of BitGrid.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace roomradar {

/// Constant 3D grid with one bit per voxel. Only words with a set voxel take memory: 12 bytes each. Rows and
/// words as in BitGrid.
class SparseBitGrid {
 public:
  SparseBitGrid() = default;
  /// @param set  voxels that are set, in any order, also repeated; those outside the grid are ignored
  SparseBitGrid(const Eigen::Vector3i& size, std::span<const Eigen::Vector3i> set);

  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }
  [[nodiscard]] std::size_t memory_bytes() const;
  [[nodiscard]] bool at(const Eigen::Vector3i& p) const;

  [[nodiscard]] std::size_t words_a_row() const { return words_a_row_; }
  /// Sets `words` to the rows of a plane, y after y. All are clear if z is outside the grid.
  void read_plane(int z, std::vector<std::uint64_t>& words) const;

 private:
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::size_t words_a_row_ = 0;
  std::vector<std::uint32_t> indices_;  // of words_ in the whole grid, increasing
  std::vector<std::uint64_t> words_;
};

/// Rows of the grids that block steps along x, y and z, for the steps from or to one row. A null pointer is a
/// row outside the grid.
struct BlockedRows {
  const std::uint64_t *x, *y_before, *y, *z_before, *z;
};

/// Reads rows of three grids of one size, a plane at a time.
class BlockedPlanes {
 public:
  /// @param blocked  per axis; must outlive this object
  explicit BlockedPlanes(const std::array<SparseBitGrid, 3>& blocked) : blocked_(blocked) {}

  /// Returns the rows for the steps from or to row (y, z). They are valid until the next call.
  BlockedRows around(int y, int z);

 private:
  const std::array<SparseBitGrid, 3>& blocked_;
  int z_ = -1;  ///< of the planes
  std::vector<std::uint64_t> x_, y_, z_before_, z_after_;
};

}  // namespace roomradar
