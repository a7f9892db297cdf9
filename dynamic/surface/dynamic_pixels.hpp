// dynamic_pixels.hpp: dynamic pixels as bits and inverse depths, with a smoothed outline.
#pragma once
#include <vector>

#include "dynamic/surface/pixel_bits.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Stores inverse depths, since a plane's inverse depth is linear over the image.
struct DynamicPixels {
  PixelBits measured;  ///< in the mask and with depth
  /// `measured` with a smooth outline: majority of the surrounding 3 x 3 pixels. Every pixel of `measured` is
  /// in `smooth`, has a neighbour in it, or is in `thin`.
  PixelBits smooth;
  PixelBits thin;  ///< lines and specks too thin for `smooth`
  /// 1/m per pixel. In `smooth` but not `measured`: mean of the measured neighbours; outside both:
  /// meaningless.
  std::vector<float> inverse_depth;
};

/// Converts a frame's dynamic pixels. Allocates only when the size grows.
/// @param depth_m       metres; 0, not finite or beyond 10 km: not measured
/// @param dynamic_mask  same size; not 0: dynamic
void take_dynamic_pixels(const DepthImage& depth_m, const MaskImage& dynamic_mask, DynamicPixels& pixels);

}  // namespace roomradar
