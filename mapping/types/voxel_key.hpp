// cell_code.hpp: the cells of a grid: which one a voxel is in, as keys of a hash table, and those round one.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace roomradar {

/// a / b rounded down, below zero, too; b > 0.
inline int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

/// One number a cell; different for cells that are less than 2^21 apart along each axis.
inline std::uint64_t cell_code(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto field = [](std::int64_t i) { return static_cast<std::uint64_t>(i + (1 << 20)) & 0x1F'FFFFU; };
  return field(x) | field(y) << 21U | field(z) << 42U;
}
inline std::uint64_t cell_code(const Eigen::Vector3i& cell) {
  return cell_code(cell.x(), cell.y(), cell.z());
}

inline constexpr int kCellsRound = 27;
inline constexpr int kOwnCell = 13;
/// From a cell to the i-th of those round it, itself (kOwnCell) among them.
inline Eigen::Vector3i cell_round(int i) { return {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}; }

}  // namespace roomradar
