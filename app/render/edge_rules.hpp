// edge_rules.hpp: tests for depth discontinuities and colour differences between adjacent pixels.
#pragma once
#include <algorithm>
#include <cmath>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Twice the variance of colour differences within a surface.
inline constexpr float kAlike2 = 2.0F * 144.0F;

/// Returns the squared distance of two colours.
inline float squared_distance(const Rgb& a, const Rgb& b) {
  const int r = a.r - b.r, g = a.g - b.g, blue = a.b - b.b;
  return static_cast<float>(r * r + g * g + blue * blue);
}

/// Returns true if there is a depth discontinuity between adjacent pixels. Depths are in m; 0: no surface.
inline bool is_depth_jump(float a_m, float b_m) {
  constexpr float kJump = 0.02F;  // fraction of the depth; a table seen at 20 degrees: 0.005 per pixel
  return std::abs(a_m - b_m) > kJump * std::min(a_m, b_m);
}

}  // namespace roomradar
