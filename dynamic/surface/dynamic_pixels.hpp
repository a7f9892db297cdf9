// moved_pixels.hpp: the pixels that moved, as bits and inverse depths, with their outline made smooth.
#pragma once
#include <vector>

#include "dynamic/surface/pixel_bits.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Inverse depths, since a plane is linear in them over the image.
struct MovedPixels {
  PixelBits measured;  ///< in the mask, and with depth
  /// The same with a smooth outline: what most of the 3 x 3 pixels around are. Every pixel of `measured` is
  /// in this, beside a pixel that is, or in `thin`.
  PixelBits smooth;
  PixelBits thin;  ///< lines and specks that are too thin for that
  /// 1/m, one a pixel; of those in `smooth` alone the mean of the measured about it; elsewhere meaningless.
  std::vector<float> inverse_depth;
};

/// @param depth_m     metres; what is 0, not finite or beyond 10 km is not measured
/// @param moved_mask  same size, not 0 = in
/// Allocates when the size grows, else never.
void take_moved_pixels(const DepthImage& depth_m, const MaskImage& moved_mask, MovedPixels& pixels);

}  // namespace roomradar
