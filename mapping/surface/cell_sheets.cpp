// cell_sheets.cpp: joins the crossings of a cell's faces.
#include "mapping/surface/cell_sheets.hpp"

#include <numeric>

#include "mapping/types/disjoint_sets.hpp"

namespace roomradar {
namespace {

// The four corners of a face, in cyclic order. Face 2 a + s is side s of axis a.
std::array<unsigned, 4> face_corners(unsigned face) {
  const unsigned axis = face / 2;
  const unsigned second = 1U << (axis + 1) % 3;
  const unsigned third = 1U << (axis + 2) % 3;
  const unsigned base = (face & 1U) << axis;
  return {base, base | second, base | second | third, base | third};
}

bool is_inside(unsigned signs, unsigned corner) { return (signs >> corner & 1U) != 0; }

}  // namespace

unsigned edge_between(unsigned a, unsigned b) {
  for (unsigned e = 0; e < kCellEdges.size(); ++e)
    if (kCellEdges[e] == std::array{a, b} || kCellEdges[e] == std::array{b, a}) return e;
  return 12;
}

Sheets sheets_of(unsigned signs, unsigned outsides_parted) {
  std::array<unsigned, 12> parent{};
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](unsigned e) {
    return find_root(e, [&](unsigned of) -> unsigned& { return parent[of]; });
  };
  const auto is_diagonal = [&](const std::array<unsigned, 4>& c) {
    return is_inside(signs, c[0]) != is_inside(signs, c[1]) &&
           is_inside(signs, c[0]) == is_inside(signs, c[2]) &&
           is_inside(signs, c[1]) == is_inside(signs, c[3]);
  };
  for (unsigned face = 0; face < 6; ++face) {
    const std::array<unsigned, 4> corner = face_corners(face);
    const auto edge = [&](unsigned i) { return edge_between(corner[i % 4], corner[(i + 1) % 4]); };
    if (is_diagonal(corner)) {
      const bool part_inside = (outsides_parted >> face & 1U) == 0;
      for (unsigned i = 0; i < 4; ++i)
        if (is_inside(signs, corner[i]) == part_inside) parent[root(edge(i + 3))] = root(edge(i));
    } else {
      unsigned first = 12;
      for (unsigned i = 0; i < 4; ++i) {
        if (is_inside(signs, corner[i]) == is_inside(signs, corner[(i + 1) % 4])) continue;
        if (first == 12) first = edge(i);
        parent[root(edge(i))] = root(first);
      }
    }
  }
  Sheets sheets;
  std::array<int, 12> number{};
  number.fill(-1);
  for (unsigned e = 0; e < 12; ++e) {
    if (is_inside(signs, kCellEdges[e][0]) == is_inside(signs, kCellEdges[e][1])) continue;
    int& own = number[root(e)];
    if (own < 0) own = sheets.count++;
    sheets.of_edge[e] = static_cast<std::uint8_t>(own);
  }
  for (unsigned face = 0; face < 6; ++face) {
    const std::array<unsigned, 4> corner = face_corners(face);
    if (!is_diagonal(corner)) continue;
    bool joined = true;
    for (unsigned i = 0; i < 4; ++i)
      joined &=
          root(edge_between(corner[i], corner[(i + 1) % 4])) == root(edge_between(corner[0], corner[1]));
    if (joined) sheets.joined_faces |= 1U << face;
  }
  return sheets;
}

const Sheets& default_sheets(unsigned signs) {
  static const std::array<Sheets, 256> table = [] {
    std::array<Sheets, 256> made;
    for (unsigned i = 0; i < 256; ++i) made[i] = sheets_of(i, 0);
    return made;
  }();
  return table[signs];
}

}  // namespace roomradar
