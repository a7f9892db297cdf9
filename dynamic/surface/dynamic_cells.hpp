// dynamic_cells.hpp: classifies cells of 4 x 4 pixels as flat, cut by an outline (contour of the mask or of a
// surface), or full.
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
  kFlat,  ///< all pixels dynamic, all four lattice points flat; may join larger triangles
  kCut,   ///< meshed as one polygon for each of up to four surfaces
  kFull,  ///< meshed with a vertex at every pixel
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

/// Triangle whose vertices are pixels, given as indices into the image. Counter-clockwise as seen by the
/// camera.
using PixelTriangle = std::array<std::uint32_t, 3>;

/// Cells of one frame. Below, a square is a block of 8 x 8 cells (kSquareCells).
struct DynamicCells {
  std::vector<CellKind> kinds;                 ///< one per cell; a cell is between four lattice points
  std::vector<std::uint8_t> is_flat;           ///< 1 if the kind is kFlat
  std::vector<std::array<CellBits, 4>> parts;  ///< pixels of each surface of a cut cell
  std::vector<std::uint8_t> must_be_vertex;    ///< one per lattice point; 1 at all corners of cut and full
                                               ///< cells
  CellCounts counts;
  /// Number of full cells per region. A cell within several balls is counted for the first of them.
  std::vector<std::uint32_t> fine_of_region;
  std::vector<PixelTriangle> triangles;       ///< triangles of cut and full cells, square by square
  std::vector<std::uint8_t> has_flat;         ///< one per square; 1: contains flat cells
  std::vector<std::uint32_t> first_triangle;  ///< per square, index into triangles; the last entry is the end
};

/// The balls to mesh at full resolution.
struct FineBalls {
  std::span<const FineBall> balls;  ///< every cell that a ball reaches becomes full
  std::size_t regions = 0;          ///< number of regions; each FineBall::region must be less
};

struct CellRules {
  DepthDiscontinuity jump;  ///< test between neighbouring pixels
  float most_sigmas;  ///< max RMS distance of a cut cell's pixels from its triangles; above it the cell is
                      ///< full
};

/// Classifies the cells and makes the triangles of cut and full cells.
void make_cells(const DynamicPixels& pixels, const DynamicLattice& lattice, const Intrinsics& camera,
                const FineBalls& fine, const CellRules& rules, DynamicCells& cells);

}  // namespace roomradar
