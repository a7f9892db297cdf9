// object_layer.hpp: supersampled colour and depth of the rendered virtual objects.
#pragma once
#include "mapping/types/image.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {

/// Rendered objects in a rectangle of the camera's image. Each pixel (x, y) of rect has samples x samples
/// sub-pixels. In `colour` and `depth_m`, sub-pixel (i, j) with 0 <= i, j < samples is at ((x - rect.x) *
/// samples + i, (y - rect.y) * samples + j).
struct ObjectLayer {
  /// Rectangle in the camera's image; width 0 if no object is in view.
  PixelRect rect;
  /// Number of sub-pixels per pixel along each axis.
  int samples = 2;
  /// Colours of the sub-pixels; undefined where depth_m is 0.
  ColourImage colour;
  /// Depth of the sub-pixels along the optical axis; 0 where no object was drawn.
  DepthImage depth_m;
};

}  // namespace roomradar
