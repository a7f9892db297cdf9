// rtin.hpp: right-triangulated irregular network (RTIN), an adaptive crack-free mesh of a lattice.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace roomradar {

/// RTIN over a grid of points. Each square of 8 x 8 cells is two right triangles. Triangles are bisected at
/// the middle of their hypotenuse, down to half a cell. The two triangles that share a hypotenuse are
/// bisected together. Every bisection includes the coarser bisections above it. Hence there are no
/// T-junctions. Source: Evans, Kirkpatrick, Townsend, Right-triangulated irregular networks, Algorithmica
/// 2001.
struct Rtin {
  int columns = 0, rows = 0;            ///< number of points: multiples of 8, plus one
  std::span<const std::uint8_t> cells;  ///< (columns - 1) * (rows - 1) values; 1: the cell is wanted

  [[nodiscard]] std::size_t point(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool is_wanted(int column, int row) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns - 1) +
                 static_cast<std::size_t>(column)] == 1;
  }
};

/// Marks the points at which triangles must be bisected for all values to be within tolerance.
///
/// @param values      one per point, valid at the corners of wanted cells
/// @param tolerances  one per point: max difference between the value and the triangle at this point
/// @param needed      input and output, one per point. Must be 1 at all corners of unwanted cells adjacent to
///                    a wanted cell, else 0. Marked points become 1. Entries of 1 stay 1
void find_needed(const Rtin& grid, std::span<const float> values, std::span<const float> tolerances,
                 std::span<std::uint8_t> needed);

struct GridPoint {
  int x, y;
};

namespace rtin {

/// Calls take() for each leaf triangle on wanted cells below a triangle a, b, c. The triangle has its right
/// angle at c and is counter-clockwise with y down.
template <typename Take>
void descend(const Rtin& grid, std::span<const std::uint8_t> needed, GridPoint a, GridPoint b, GridPoint c,
             const Take& take) {
  const int x = a.x + b.x, y = a.y + b.y;
  if (((x | y) & 1) == 0) {
    const GridPoint middle{x / 2, y / 2};
    if (needed[grid.point(middle.x, middle.y)] != 0) {
      descend(grid, needed, c, a, middle, take);
      descend(grid, needed, b, c, middle, take);
      return;
    }
  }
  // A leaf triangle covers wanted cells only, or none: test the cell at its right angle.
  if (grid.is_wanted(c.x - (x < 2 * c.x ? 1 : 0), c.y - (y < 2 * c.y ? 1 : 0))) take(a, b, c);
}

}  // namespace rtin

/// Calls take(a, b, c) for each triangle on wanted cells in the square whose top left point is (column, row).
template <typename Take>
void walk_square(const Rtin& grid, std::span<const std::uint8_t> needed, int column, int row,
                 const Take& take) {
  using rtin::descend;
  const GridPoint top_left{column, row}, bottom_left{column, row + 8};
  const GridPoint bottom_right{column + 8, row + 8}, top_right{column + 8, row};
  const GridPoint middle{column + 4, row + 4};
  if (needed[grid.point(middle.x, middle.y)] != 0) {
    descend(grid, needed, top_left, bottom_left, middle, take);
    descend(grid, needed, bottom_left, bottom_right, middle, take);
    descend(grid, needed, bottom_right, top_right, middle, take);
    descend(grid, needed, top_right, top_left, middle, take);
  } else if (((column / 8 + row / 8) & 1) == 0) {
    descend(grid, needed, bottom_right, top_left, bottom_left, take);
    descend(grid, needed, top_left, bottom_right, top_right, take);
  } else {
    descend(grid, needed, bottom_left, top_right, top_left, take);
    descend(grid, needed, top_right, bottom_left, bottom_right, take);
  }
}

}  // namespace roomradar
