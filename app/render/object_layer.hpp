// object_layer.hpp: the virtual objects' picture and depth, finer than the camera's pixels.
#pragma once
#include "mapping/types/image.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {

/// Pixel (x, y) of the camera's image, if in rect, is covered by samples x samples sub-pixels: those at
/// ((x - rect.x) * samples + i, (y - rect.y) * samples + j) with i, j < samples.
struct ObjectLayer {
  PixelRect rect;      ///< of the camera's image; width 0: nothing is in view
  int samples = 2;     ///< sub-pixels a pixel and axis
  ColourImage colour;  ///< sub-pixels; meaningless where depth_m is 0
  DepthImage depth_m;  ///< sub-pixels, along the optical axis; 0 where no object is
};

}  // namespace roomradar
