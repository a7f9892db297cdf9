// run_grid.hpp: a 3D grid of bits as runs of set cells, for large connected regions.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/surface/unknown/bit_grid.hpp"

namespace roomradar {

/// Constant 3D grid with one bit per cell. Takes 8 bytes per run of set cells along x, and 4 bytes per row; a
/// run that fills a row continues in the next. Cells are numbered with x fastest and z slowest.
class RunGrid {
 public:
  RunGrid() = default;
  /// Holds the same bits; the grid must have less than 2^32 cells.
  explicit RunGrid(const BitGrid& bits);
  /// @param ends  number of the first cell of a run, number of the cell after its last, first cell of the
  ///              next run, and so on: strictly increasing, even count, the last at most the number of cells
  RunGrid(const Eigen::Vector3i& size, std::vector<std::uint32_t> ends);

  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Returns false outside the grid.
  [[nodiscard]] bool at(const Eigen::Vector3i& p) const;
  /// Returns the runs, as the constructor takes them.
  [[nodiscard]] std::span<const std::uint32_t> ends() const { return ends_; }
  friend bool operator==(const RunGrid&, const RunGrid&) = default;

 private:
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<std::uint32_t> ends_;
  /// Per row, and for the end of the last: number of entries of ends_ that are at most the row's first cell.
  std::vector<std::uint32_t> before_row_;

  void count_before_rows();
};

}  // namespace roomradar
