// morton.hpp: Morton codes (Z-order) of grid cells.
#pragma once
#include <cstdint>

namespace roomradar {

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

}  // namespace roomradar
