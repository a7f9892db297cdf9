// bit_grid.hpp: a 3D grid of bits with set operations and morphological operations on 64 voxels of a row at a
// time.
#pragma once
#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/surface/unknown/sparse_bit_grid.hpp"

namespace roomradar {

/// 3D grid with one bit per voxel. Rows run along x, with 64 voxels per word. All functions treat voxels
/// outside the grid as clear. Unused bits in the last word of a row are always clear.
class BitGrid {
 public:
  BitGrid() = default;
  /// Sets all voxels to `value`. Sizes must be >= 0.
  BitGrid(const Eigen::Vector3i& size, bool value);

  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }
  [[nodiscard]] std::size_t memory_bytes() const { return words_.size() * sizeof(std::uint64_t); }
  [[nodiscard]] bool at(const Eigen::Vector3i& p) const;
  /// Sets one voxel. Has no effect outside the grid.
  void set(const Eigen::Vector3i& p, bool value) { set_box(p, p + Eigen::Vector3i::Ones(), value); }
  /// Sets the voxels in [low, high), clipped to the grid.
  void set_box(const Eigen::Vector3i& low, const Eigen::Vector3i& high, bool value);

  /// Both grids must have the same size.
  BitGrid& operator&=(const BitGrid& other);
  BitGrid& operator|=(const BitGrid& other);
  /// Sets all clear voxels and clears all set ones.
  BitGrid& flip();
  friend bool operator==(const BitGrid&, const BitGrid&) = default;

  /// Keeps the voxels whose next `steps` (0..63) voxels along the axis are all set.
  BitGrid& erode(int axis, int steps);
  /// Sets the next `steps` (0..63) voxels along the axis after each set voxel.
  BitGrid& dilate(int axis, int steps);

  /// Clears all voxels whose coordinates are not all multiples of `spacing` (>= 1).
  void keep_multiples_of(int spacing);

  /// Dilates by one step along the axes, restricted to the voxels set in `where`. A voxel set in
  /// blocked[axis] blocks the steps between it and the next voxel along the axis in both directions. All
  /// grids must have the same size.
  void spread(const BitGrid& where, const std::array<SparseBitGrid, 3>& blocked);
  /// Dilates by one step everywhere.
  void spread(const std::array<SparseBitGrid, 3>& blocked);
  /// Repeats spread() until nothing changes.
  void flood(const BitGrid& where, const std::array<SparseBitGrid, 3>& blocked);

  /// Calls visit(p) for each set voxel, z slowest, x fastest. `visit` may clear voxels; cleared voxels in the
  /// current word of 64 voxels are still visited.
  template <typename Visit>
  void for_each_set(const Visit& visit) const {
    for (int z = 0; z < size_.z(); ++z)
      for (int y = 0; y < size_.y(); ++y)
        for (std::size_t i = 0; i < words_a_row_; ++i)
          for (std::uint64_t word = row(y, z)[i]; word != 0; word &= word - 1) {
            const int x = static_cast<int>(64 * i) + std::countr_zero(word);
            if (x < size_.x()) visit(Eigen::Vector3i(x, y, z));
          }
  }
  /// Calls visit(p) for each set voxel whose neighbour at `step` (-1 or 1) along the axis is set in `other`.
  /// A voxel set in `blocked` blocks the step between it and the next voxel along the axis. All grids must
  /// have the same size. Order as for_each_set().
  template <typename Visit>
  void for_each_set_beside(const BitGrid& other, int axis, int step, const SparseBitGrid& blocked,
                           const Visit& visit) const {
    BesideRow beside{axis, step, other, blocked, {}, {}};
    for (int z = 0; z < size_.z(); ++z)
      for (int y = 0; y < size_.y(); ++y) {
        beside.read(y, z);
        for (std::size_t i = 0; i < words_a_row_; ++i)
          for (std::uint64_t word = row(y, z)[i] & beside.words[i]; word != 0; word &= word - 1)
            visit(Eigen::Vector3i(static_cast<int>(64 * i) + std::countr_zero(word), y, z));
      }
  }
  /// Calls visit(first voxel, length) for each run of set voxels along x, in the order of for_each_set(). A
  /// run that crosses a multiple of 64 in x is visited as several consecutive runs.
  template <typename Visit>
  void for_each_run(const Visit& visit) const {
    for (int z = 0; z < size_.z(); ++z)
      for (int y = 0; y < size_.y(); ++y)
        for (std::size_t i = 0; i < words_a_row_; ++i) {
          std::uint64_t word = row(y, z)[i];
          for (int bit = 0; word != 0;) {
            const int clear = std::countr_zero(word);
            word >>= clear;
            const int length = std::countr_one(word);
            visit(Eigen::Vector3i(static_cast<int>(64 * i) + bit + clear, y, z), length);
            bit += clear + length;
            word = length == 64 ? 0 : word >> length;
          }
        }
  }

 private:
  /// The neighbours at `step` along the axis of a row's voxels, with those behind a block clear.
  struct BesideRow {
    int axis, step;
    const BitGrid& other;
    const SparseBitGrid& blocked;
    std::vector<std::uint64_t> words;  ///< read() sets them; bits past the row's end are arbitrary
    std::vector<std::uint64_t> plane;  ///< of `blocked`
    void read(int y, int z);
  };
  [[nodiscard]] std::size_t row_index(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y);
  }
  [[nodiscard]] std::uint64_t* row(int y, int z) { return words_.data() + row_index(y, z) * words_a_row_; }
  [[nodiscard]] const std::uint64_t* row(int y, int z) const {
    return words_.data() + row_index(y, z) * words_a_row_;
  }
  /// Words from a row to the next along y or z.
  [[nodiscard]] std::size_t stride_words(int axis) const {
    return words_a_row_ * (axis == 1 ? 1 : static_cast<std::size_t>(size_.y()));
  }
  void clear_row_ends();
  void spread(const BitGrid* where, const std::array<SparseBitGrid, 3>& blocked);
  struct Rows;
  static bool spread_to_row(std::uint64_t* row, const Rows& source, const std::uint64_t* where,
                            const BlockedRows& bars, std::size_t words);

  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::size_t words_a_row_ = 0;
  std::vector<std::uint64_t> words_;
};

/// Returns the morphological opening by a cube. Keeps the voxels that are in a cube of edge x edge x edge set
/// voxels, and removes thinner structures. With lattice > 1, considers only cubes whose lowest voxel's
/// coordinates are multiples of `lattice`. edge (at most 64) and lattice must be >= 1.
BitGrid opened(BitGrid bits, int edge, int lattice = 1);

}  // namespace roomradar
