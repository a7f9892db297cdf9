// dynamic_pixels.hpp: a depth frame divided into dynamic pixels and static model; the dynamic pixels as bits
// and inverse depths, with a smoothed outline (contour of the mask).
#pragma once
#include <vector>

#include "dynamic/surface/pixel_bits.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// A depth frame, its dynamic pixels, and the static model's depth in the same view. Refers to the images,
/// which must outlive it and have the size of `measured`.
struct DynamicView {
  PosedDepth measured;
  const MaskImage& dynamic_mask;       ///< not 0: dynamic
  const DepthImage& expected_depth_m;  ///< depth of the static model, m; 0: unknown
};

/// Dynamic pixels of one frame. Depths are stored as inverse depths because a plane's inverse depth is linear
/// over the image.
struct DynamicPixels {
  /// Pixels in the mask that have depth, and pixels without depth in narrow gaps of their surface.
  PixelBits measured;
  /// `measured` with a smooth outline: a pixel is set if most of the surrounding 3 x 3 pixels are in
  /// `measured`. Every pixel of `measured` is in `smooth`, has a neighbour in `smooth`, or is in `thin`.
  PixelBits smooth;
  PixelBits thin;  ///< lines and specks that are too thin for `smooth`
  /// Inverse depth per pixel, 1/m. For a pixel in `smooth` but not in `measured`, the mean of the measured
  /// neighbours. Meaningless for a pixel in neither, and for the 8 elements after the last pixel, which
  /// vector instructions may read.
  std::vector<float> inverse_depth;
};

/// Converts a frame's dynamic pixels. Allocates only when the size grows.
/// @param depth_m       metres; 0, not finite or beyond 10 km: not measured
/// @param dynamic_mask  same size; not 0: dynamic
void take_dynamic_pixels(const DepthImage& depth_m, const MaskImage& dynamic_mask, DynamicPixels& pixels);

}  // namespace roomradar
