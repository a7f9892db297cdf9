// cell_jumps.cpp: compares neighbouring pixels, and finds connected surfaces by bit shifts.
#include "dynamic/surface/cell_jumps.hpp"

#include <bit>

namespace roomradar {
namespace {

constexpr CellBits kNotLastColumn = 0b01111'01111'01111'01111'01111U;

}  // namespace

CellJumps find_jumps(CellBits in, const CellValues& values, const DepthDiscontinuity& rule) {
  CellJumps jumps;
  for (CellBits left = in & in >> 1 & kNotLastColumn; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(left));
    if (!rule.is_one_surface_inverse(values[k], values[k + 1])) jumps.right |= left & -left;
  }
  for (CellBits above = in & in >> 5; above != 0; above &= above - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(above));
    if (!rule.is_one_surface_inverse(values[k], values[k + 5])) jumps.down |= above & -above;
  }
  return jumps;
}

CellBits take_surface(CellBits in, const CellJumps& jumps) {
  const CellBits can_right = in & in >> 1 & kNotLastColumn & ~jumps.right;
  const CellBits can_down = in & in >> 5 & ~jumps.down;
  CellBits surface = in & -in;
  for (CellBits before = 0; before != surface;) {
    before = surface;
    surface |= (surface & can_right) << 1 | (surface >> 1 & can_right);
    surface |= (surface & can_down) << 5 | (surface >> 5 & can_down);
  }
  return surface;
}

}  // namespace roomradar
