// moved_cells.hpp: the cells between lattice points: flat ones, those that an outline cuts, and those in
// full.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dynamic/surface/cell_outline.hpp"
#include "dynamic/surface/depth_discontinuity.hpp"
#include "dynamic/surface/dynamic_lattice.hpp"
#include "dynamic/surface/dynamic_pixels.hpp"

namespace roomradar {

enum class CellKind : std::uint8_t {
  kEmpty,
  kFlat,  ///< all in, all four corners flat: may be part of larger triangles
  kCut,   ///< a polygon each of up to four surfaces
  kFull,  ///< a vertex at every pixel
};

/// A ball in the camera frame, m, within which every pixel becomes a vertex.
struct FineBall {
  Eigen::Vector3f centre_camera;
  float radius_m;
  std::size_t region;  ///< what it was asked for by
};

/// How many cells are of a kind.
struct CellCounts {
  std::size_t flat = 0, cut = 0, full = 0;
};

/// Vertices are pixels, as places in the image. Counter-clockwise as the camera sees them.
using PixelTriangle = std::array<std::uint32_t, 3>;

struct MovedCells {
  std::vector<CellKind> kinds;                 ///< one between each four lattice points
  std::vector<std::uint8_t> is_flat;           ///< 1 where the kind is kFlat
  std::vector<std::array<CellBits, 4>> parts;  ///< of cut cells: the pixels of each surface
  std::vector<std::uint8_t> must_be_vertex;    ///< one a lattice point: all corners of cut and full cells
  CellCounts counts;
  std::vector<std::uint32_t> fine_of_region;  ///< full cells by the first region that asks for it
  std::vector<PixelTriangle> triangles;       ///< of cut and full cells, square by square
  std::vector<std::uint8_t> has_flat;         ///< one a square: it holds flat cells
  std::vector<std::uint32_t> first_triangle;  ///< of each square, row by row, and one past the last
};

struct CellRules {
  JumpRule jump;      ///< between pixels that are neighbours
  float most_sigmas;  ///< RMS over the pixels of a cut cell from its triangles; more, and the cell is full
};

/// Sorts the cells and makes the triangles of those that are cut or full.
/// @param regions  more than the region of any ball
void make_cells(const MovedPixels& pixels, const MovedLattice& lattice, const Intrinsics& camera,
                std::span<const FineBall> fine, std::size_t regions, const CellRules& rules,
                MovedCells& cells);

}  // namespace roomradar
