// dynamic_lattice.hpp: the dynamic surface at every fourth pixel, with its noise reduced by averaging.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic/surface/cell_outline.hpp"
#include "dynamic/surface/dynamic_pixels.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Edge length, in cells of kCell_px pixels, of the squares that are triangulated separately.
constexpr int kSquareCells = 8;

/// Noise of a pixel's inverse depth.
class InverseDepthNoise {
 public:
  explicit InverseDepthNoise(const DepthNoise& noise = {});
  /// Returns the standard deviation, 1/m.
  /// @param tangent2  squared tangent of the angle between view ray and surface normal
  [[nodiscard]] float sigma_per_m(float inverse_depth, float tangent2) const;
  [[nodiscard]] const DepthNoise& model() const { return noise_; }

 private:
  static constexpr int kSteps = 128;
  DepthNoise noise_;
  /// The angle-dependent term, times sqrt(depth), by the angle's cosine.
  std::array<float, kSteps + 2> grazing_by_cosine_;
};

/// Lattice of points at the pixels (kCell_px * column, kCell_px * row), row-major. The cells between the
/// points cover the image and form whole squares of kSquareCells x kSquareCells. Points beyond the image are
/// not dynamic.
struct DynamicLattice {
  InverseDepthNoise noise;
  int columns = 0, rows = 0;  ///< number of points: a multiple of kSquareCells plus one
  /// Inverse depth, 1/m; 0 where the pixel is not dynamic. Averaged over pairs of pixels on opposite sides of
  /// the point, which leaves planes unchanged.
  std::vector<float> inverse_depth;
  std::vector<float> sigma;  ///< noise of one pixel at this depth and angle, 1/m
  /// 1 if the 5 x 5 pixels around the point are all dynamic and, within noise, on a plane.
  std::vector<std::uint8_t> is_flat;
  std::vector<float> raw;  // scratch: inverse_depth before flat points are averaged with their neighbours

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/// Returns a dynamic pixel's smoothed inverse depth, 1/m: the mean of the pixel and pairs of opposite pixels
/// among the surrounding 5 x 5 pixels. A pair is used if its mean is within 3 sigmas of the pixel. Outlines
/// (contours of the mask) do not move, and bends change by less than 3 sigmas.
float smoothed_inverse_depth(const DynamicPixels& pixels, const InverseDepthNoise& noise, int x, int y);

/// Computes the lattice of a frame.
/// @param noise        of the sensor
/// @param flat_sigmas  max RMS distance of 5 x 5 pixels from a plane for the point to be flat, in sigmas
void make_lattice(const DynamicPixels& pixels, const Intrinsics& camera, const DepthNoise& noise,
                  float flat_sigmas, DynamicLattice& lattice);

}  // namespace roomradar
