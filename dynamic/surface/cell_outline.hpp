// cell_outline.hpp: convex polygon for the part of a cell of 4 x 4 pixels that a surface covers.
#pragma once
#include <array>
#include <cstdint>

namespace roomradar {

/// A set of pixels of a cell: bit 5 * y + x. A cell is 4 pixels wide but has 5 x 5 pixels, since neighbouring
/// cells share the pixels on their sides.
using CellBits = std::uint32_t;
constexpr int kCell_px = 4;
constexpr CellBits kWholeCell = (CellBits{1} << 25) - 1;

/// Position of a pixel in a cell, 0 to 4.
struct CellPixel {
  std::int8_t x, y;
};
/// The ring of the 16 pixels on a cell's sides, counter-clockwise as seen by the camera (x right, y down).
/// The ring begins at the top left and runs down the left side (indices 0 to 4), along the bottom, up the
/// right side and back along the top.
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

/// `count` consecutive pixels of the ring, beginning with `first`. A count of 16 is the whole ring.
struct RingArc {
  int first = 0, count = 0;
};

/// Returns true if a convex polygon can represent the pixels of one surface in a cell. The pixels on the ring
/// must be consecutive, and are returned in `arc`. The line between the ends of the arc bounds the polygon.
/// Surface pixels outside the polygon and empty pixels inside it must be within about one pixel of the line.
/// If all pixels of the ring are set, the polygon is the whole cell, including empty pixels inside.
bool find_outline(CellBits pixels, RingArc& arc);

/// Triangles of a polygon. The numbers are indices into the polygon's list of corners.
struct CellTriangles {
  std::array<std::array<std::uint8_t, 3>, 14> triangles;
  int count = 0;
};
/// Triangulates a convex polygon.
/// @param corners  corners of the polygon: 0 to 16 indices into kRing, in ring order
/// @return counter-clockwise triangles of positive area; none if all corners are collinear
CellTriangles triangulate(const int* corners, int count);

}  // namespace roomradar
