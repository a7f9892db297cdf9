// moved_lattice.hpp: the surface of what moved at every fourth pixel, with its noise averaged away.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic/surface/cell_outline.hpp"
#include "dynamic/surface/dynamic_pixels.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Squares of this many cells of kCell_px pixels are meshed as a whole where they are flat.
constexpr int kSquareCells = 8;

/// Points at pixels (kCell_px * column, kCell_px * row), rows first. The cells between them cover the image
/// and make whole squares; points beyond the image are not in.
struct MovedLattice {
  int columns = 0, rows = 0;  ///< of points: a multiple of kSquareCells plus one
  /// 1/m, 0 where the pixel is not in. Averaged over pairs of pixels that lie opposite each other, which
  /// leaves planes as they are.
  std::vector<float> inverse_depth;
  std::vector<float> sigma;  ///< 1/m, noise of one pixel at this depth and angle
  /// The 5 x 5 pixels about the point are all in, and are a plane but for noise.
  std::vector<std::uint8_t> is_flat;
  std::vector<float> raw;  // before points were averaged with their neighbours

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/// Noise of inverse depth, 1/m, on a surface whose tangent of the angle between view ray and normal is given.
float inverse_depth_sigma(float inverse_depth, float tangent2);

/// A pixel that is in, averaged with those of the 5 x 5 about it that lie opposite each other and differ from
/// a line by noise alone: outlines stay, bends are rounded off by less than the noise. 1/m.
float smoothed_inverse_depth(const MovedPixels& pixels, int x, int y);

/// @param flat_sigmas  five by five pixels that differ from a plane by this much (RMS) are flat
void make_lattice(const MovedPixels& pixels, const Intrinsics& camera, float flat_sigmas,
                  MovedLattice& lattice);

}  // namespace roomradar
