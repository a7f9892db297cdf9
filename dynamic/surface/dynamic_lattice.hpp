// dynamic_lattice.hpp: the dynamic surface at every fourth pixel, with its noise reduced by averaging.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic/surface/cell_outline.hpp"
#include "dynamic/surface/dynamic_pixels.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Edge length, in cells of kCell_px pixels, of the squares that are triangulated separately.
constexpr int kSquareCells = 8;

/// Points at pixels (kCell_px * column, kCell_px * row), row-major. The cells between them cover the image
/// and form whole squares; points beyond the image are not dynamic.
struct DynamicLattice {
  int columns = 0, rows = 0;  ///< number of points: a multiple of kSquareCells plus one
  /// 1/m, 0 where the pixel is not dynamic. Averaged symmetrically about the point, which leaves planes
  /// unchanged.
  std::vector<float> inverse_depth;
  std::vector<float> sigma;  ///< 1/m, noise of one pixel at this depth and angle
  /// 1 if the 5 x 5 pixels around the point are all dynamic, and on a plane within noise.
  std::vector<std::uint8_t> is_flat;
  std::vector<float> raw;  // scratch: inverse_depth before flat points are averaged with their neighbours

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/// Returns one sigma of a pixel's inverse depth, 1/m.
/// @param tangent2  squared tangent of the angle between view ray and surface normal
float inverse_depth_sigma(float inverse_depth, float tangent2);

/// Returns a dynamic pixel's inverse depth (1/m), averaged with those pairs of opposite pixels in the
/// surrounding 5 x 5 whose mean is within 3 sigmas of the pixel. Outlines stay, and bends change by less than
/// 3 sigmas.
float smoothed_inverse_depth(const DynamicPixels& pixels, int x, int y);

/// Computes the lattice of a frame.
/// @param flat_sigmas  5 x 5 pixels are flat if their RMS distance from a plane is at most this
void make_lattice(const DynamicPixels& pixels, const Intrinsics& camera, float flat_sigmas,
                  DynamicLattice& lattice);

}  // namespace roomradar
