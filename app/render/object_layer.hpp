// object_layer.hpp: supersampled colour and depth of the rendered virtual objects.
#pragma once
#include "mapping/types/image.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {

/// Pixel (x, y) of the camera's image, if inside rect, has samples x samples sub-pixels: ((x - rect.x) *
/// samples + i, (y - rect.y) * samples + j) with i, j < samples.
struct ObjectLayer {
  PixelRect rect;      ///< in the camera's image; width 0: nothing in view
  int samples = 2;     ///< sub-pixels per pixel and axis
  ColourImage colour;  ///< sub-pixels; undefined where depth_m is 0
  DepthImage depth_m;  ///< sub-pixels, along the optical axis; 0 = no object
};

}  // namespace roomradar
