// cell_sheets.hpp: groups the zero crossings on the edges of a cell into surface sheets (connected pieces of
// surface). A face is ambiguous if its corners have equal signs on each diagonal. Private to
// dual_marching_cubes.
#pragma once
#include <array>
#include <cstdint>

namespace roomradar {

/// Edge 4 a + k of a cell runs along axis a. Corner i is at (bit 0, bit 1, bit 2) of i.
inline constexpr std::array<std::array<unsigned, 2>, 12> kCellEdges{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/// Returns the edge between two corners; 12 if there is none.
unsigned edge_between(unsigned a, unsigned b);

/// Maps each crossed edge of a cell to its surface sheet.
struct Sheets {
  std::array<std::uint8_t, 12> of_edge{};
  int count = 0;
  unsigned joined_faces = 0;  ///< bit mask: ambiguous faces whose four crossings are one sheet
};

/// @param signs  bit i: corner i is inside
/// @param outsides_parted  bit mask of faces that, if ambiguous, separate their outside corners. Face 2 a + s
///                         is side s of axis a
Sheets sheets_of(unsigned signs, unsigned outsides_parted);

/// Returns sheets_of(signs, 0) from a table.
const Sheets& default_sheets(unsigned signs);

}  // namespace roomradar
