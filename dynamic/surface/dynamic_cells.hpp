// dynamic_cells.hpp: classifies cells of 4 x 4 pixels as flat, cut by an outline, or full.
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
  kFlat,  ///< all pixels dynamic, all four corners flat: may be part of larger triangles
  kCut,   ///< one polygon for each of up to four surfaces
  kFull,  ///< a vertex at every pixel
};

/// A ball in the camera frame, m, in which every pixel becomes a vertex.
struct FineBall {
  Eigen::Vector3f centre_camera;
  float radius_m;
  std::size_t region;  ///< index of the ball's FineRegion
};

/// Number of cells of each kind.
struct CellCounts {
  std::size_t flat = 0, cut = 0, full = 0;
};

/// Vertices are pixels, as indices into the image. Counter-clockwise as seen by the camera.
using PixelTriangle = std::array<std::uint32_t, 3>;

/// A square below is a block of 8 x 8 cells (kSquareCells).
struct DynamicCells {
  std::vector<CellKind> kinds;                 ///< one per cell, between four lattice points
  std::vector<std::uint8_t> is_flat;           ///< 1 if the kind is kFlat
  std::vector<std::array<CellBits, 4>> parts;  ///< of cut cells: the pixels of each surface
  std::vector<std::uint8_t> must_be_vertex;    ///< one per lattice point; 1 at all corners of cut and full
                                               ///< cells
  CellCounts counts;
  /// Full cells per region; counted for the first ball that reaches the cell.
  std::vector<std::uint32_t> fine_of_region;
  std::vector<PixelTriangle> triangles;       ///< of cut and full cells, square by square
  std::vector<std::uint8_t> has_flat;         ///< one per square; 1: contains flat cells
  std::vector<std::uint32_t> first_triangle;  ///< per square: index into triangles; one extra entry: end
};

struct CellRules {
  DepthDiscontinuity jump;  ///< between neighbouring pixels
  float most_sigmas;  ///< max RMS distance of a cut cell's pixels from its triangles; above it the cell is
                      ///< full
};

/// Classifies the cells and makes the triangles of cut and full cells.
/// @param fine     cells that a ball reaches become full
/// @param regions  number of regions; FineBall::region is less
void make_cells(const DynamicPixels& pixels, const DynamicLattice& lattice, const Intrinsics& camera,
                std::span<const FineBall> fine, std::size_t regions, const CellRules& rules,
                DynamicCells& cells);

}  // namespace roomradar
