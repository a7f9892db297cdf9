// object_layer.hpp: the virtual objects' picture and depth, finer than the camera's pixels, in a rectangle of its image.
#pragma once
#include <cstdint>
#include <vector>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Pixel (x, y) of the camera's image, x0_px <= x < x0_px + width_px, is covered by samples x samples sub-pixels:
/// those at ((x - x0_px) * samples + i, (y - y0_px) * samples + j) with i, j < samples.
struct ObjectLayer {
  int x0_px = 0;
  int y0_px = 0;
  int width_px = 0;   ///< 0: nothing is in view
  int height_px = 0;
  int samples = 2;    ///< sub-pixels a pixel and axis
  ColourImage colour;  ///< sub-pixels; meaningless where depth_m is 0
  DepthImage depth_m;  ///< sub-pixels, along the optical axis; 0 where no object is
};

}  // namespace roomradar
