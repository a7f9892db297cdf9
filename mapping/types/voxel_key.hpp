// voxel_key.hpp: floor division, hash keys, Morton codes (Z-order) and the 27-cell neighbourhood of integer
// grid cells.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace roomradar {

/// Returns a / b rounded towards minus infinity; b > 0.
inline int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

/// Returns the hash key of a cell. Keys are distinct for cells less than 2^21 apart along each axis.
inline std::uint64_t voxel_key(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto field = [](std::int64_t i) { return static_cast<std::uint64_t>(i + (1 << 20)) & 0x1F'FFFFU; };
  return field(x) | field(y) << 21U | field(z) << 42U;
}
inline std::uint64_t voxel_key(const Eigen::Vector3i& cell) {
  return voxel_key(cell.x(), cell.y(), cell.z());
}
/// Returns the cell of a key: the inverse of voxel_key() for coordinates from -2^20 to 2^20 - 1.
inline Eigen::Vector3i voxel_of(std::uint64_t key) {
  const auto field = [&](unsigned shift) { return static_cast<int>(key >> shift & 0x1F'FFFFU) - (1 << 20); };
  return {field(0), field(21), field(42)};
}

/// Moves bit i of a 16-bit coordinate to bit 3 i.
constexpr std::uint64_t spread_bits(std::uint32_t key) {
  std::uint64_t x = key & 0xFFFFU;
  x = (x | x << 16U) & 0xFF00'00FFU;
  x = (x | x << 8U) & 0x00F0'0F00'F00FU;
  x = (x | x << 4U) & 0x0C30'C30C'30C3U;
  x = (x | x << 2U) & 0x2492'4924'9249U;
  return x;
}

/// Returns the Morton code of coordinates in 0..65535. The code's octal digits are the child indices on the
/// path from an octree's root to the voxel (x has weight 1, y 2, z 4). This is OctoMap's child numbering for
/// 16-bit keys.
constexpr std::uint64_t morton_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread_bits(x) | spread_bits(y) << 1U | spread_bits(z) << 2U;
}

inline constexpr int kCellsRound = 27;
inline constexpr int kOwnCell = 13;
/// Returns the offset from a cell to its i-th neighbour, 0 <= i < 27; zero for i = kOwnCell.
inline Eigen::Vector3i neighbour_offset(int i) { return {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}; }

}  // namespace roomradar
