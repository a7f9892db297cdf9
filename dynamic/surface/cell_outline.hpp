// cell_outline.hpp: the surface in a cell of 4 x 4 pixels that its outline cuts, as one convex polygon.
#pragma once
#include <array>
#include <cstdint>

namespace roomradar {

/// A cell's 5 x 5 pixels, its corners and sides included: bit 5 * y + x.
using CellBits = std::uint32_t;
constexpr int kCell_px = 4;
constexpr CellBits kWholeCell = (CellBits{1} << 25) - 1;

/// A pixel of a cell.
struct CellPixel {
  std::int8_t x, y;
};
/// The 16 pixels on a cell's sides, counter-clockwise as the camera sees them (x right, y down) from the top
/// left: down the left side (0 to 4), along the bottom, up the right side, back along the top.
constexpr std::array<CellPixel, 16> kRing{{{0, 0},
                                           {0, 1},
                                           {0, 2},
                                           {0, 3},
                                           {0, 4},
                                           {1, 4},
                                           {2, 4},
                                           {3, 4},
                                           {4, 4},
                                           {4, 3},
                                           {4, 2},
                                           {4, 1},
                                           {4, 0},
                                           {3, 0},
                                           {2, 0},
                                           {1, 0}}};

/// A run of the ring's pixels: `count` of them from `first` on; 16: all.
struct RingArc {
  int first = 0, count = 0;
};

/// Whether the pixels of one surface in a cell are what a convex polygon covers: those of the ring are one
/// run, and the straight line that joins the run's ends leaves no pixel more than about one pixel outside and
/// takes in none that lies deeper. A cell whose ring is complete is covered whole, unmeasured specks within
/// it included.
bool find_outline(CellBits pixels, RingArc& arc);

/// Triangles over a polygon on the ring, as places in its list of corners.
struct CellTriangles {
  std::array<std::array<std::uint8_t, 3>, 14> triangles;
  int count = 0;
};
/// @param corners  places in kRing in its order, 0 to 16 of them
/// @return counter-clockwise, each with an area; none where all corners lie on one line
CellTriangles triangulate(const int* corners, int count);

}  // namespace roomradar
