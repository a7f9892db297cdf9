// pixel_grid.hpp: grid of square pixels over a rectangle perpendicular to a motion.
#pragma once
#include <algorithm>
#include <cmath>

namespace roomradar {

struct PixelGrid {
  double pixel_m = 0.0;
  int width_px = 0, height_px = 0;
};

/// Returns a grid of square pixels that covers the rectangle, with `resolution_px` pixels along the longer
/// side and at least one along the shorter. A rectangle without area (an object seen edge-on) gets pixels,
/// too.
inline PixelGrid fit_pixels(double width_m, double height_m, int resolution_px) {
  constexpr double kLeastSide_m = 1e-6;
  PixelGrid grid;
  grid.pixel_m = std::max({width_m, height_m, kLeastSide_m}) / resolution_px;
  const auto pixels = [&](double side_m) {
    return std::clamp(static_cast<int>(std::ceil(side_m / grid.pixel_m - 1e-9)), 1, resolution_px);
  };
  grid.width_px = pixels(width_m);
  grid.height_px = pixels(height_m);
  return grid;
}

}  // namespace roomradar
