// depth_windows.hpp: the nearest depth in any square window of a depth image, at four lookups each.
#pragma once
#include <cstdint>
#include <vector>

#include "mapping/types/image.hpp"

namespace roomradar {

inline constexpr int kMaxWindowRadius_px = 31;

/// nearest_m[k] holds, for each pixel, the least depth of the 2^k x 2^k pixels that it is the upper left
/// corner of (infinity where none of them has depth). Two such squares cover any longer side below 2^(k+1).
struct DepthWindows {
  std::vector<DepthImage> nearest_m;
  Image<std::int32_t> measured;  ///< how many pixels above and to the left of each corner have depth
};

struct WindowDepth {
  float nearest_m = 0.0F;  ///< infinity if nothing in the window has depth
  float measured_share =
      0.0F;  ///< pixels with depth, of all pixels of the window, those outside the image too
};

/// Reuses the memory of `windows`.
void build_windows(const DepthImage& depth_m, DepthWindows& windows);

/// The window of (2 radius + 1)^2 pixels round a pixel of the image; the radius is within 0 and
/// kMaxWindowRadius_px. At the image's border some pixels beside the window may count as in it.
WindowDepth window_depth(const DepthWindows& windows, int x, int y, int radius_px);

}  // namespace roomradar
