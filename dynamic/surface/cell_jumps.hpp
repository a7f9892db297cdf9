// cell_jumps.hpp: depth discontinuities within a cell of 4 x 4 pixels, and the surfaces that they separate.
#pragma once
#include <algorithm>
#include <array>

#include "dynamic/surface/cell_outline.hpp"
#include "dynamic/surface/depth_discontinuity.hpp"

namespace roomradar {

/// Inverse depths of a cell's 5 x 5 pixels, 1/m, row by row. Only those of dynamic pixels are valid.
using CellValues = std::array<float, 25>;

/// Returns a pixel's index in CellValues and its bit in CellBits.
constexpr int place(CellPixel p) { return 5 * p.y + p.x; }

/// Discontinuities between adjacent dynamic pixels. Bit k of `right` stands for pixel k and its right
/// neighbour, bit k of `down` for pixel k and the pixel below.
struct CellJumps {
  CellBits right = 0, down = 0;
  [[nodiscard]] bool any() const { return (right | down) != 0; }
  /// Returns true if a discontinuity separates the pixels a and b, which must be adjacent in a row or column.
  [[nodiscard]] bool between(CellPixel a, CellPixel b) const {
    const int first = std::min(place(a), place(b));
    return ((a.y == b.y ? right : down) >> first & 1U) != 0;
  }
};

/// Returns the discontinuities between adjacent pixels of `in`.
CellJumps find_jumps(CellBits in, const CellValues& values, const DepthDiscontinuity& rule);

/// Returns the pixels of `in` that are connected to the pixel of its lowest bit without crossing a
/// discontinuity.
CellBits take_surface(CellBits in, const CellJumps& jumps);

}  // namespace roomradar
