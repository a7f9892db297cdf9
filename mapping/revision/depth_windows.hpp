// depth_windows.hpp: sparse table for the minimum depth in square windows of a depth image, with four
// look-ups per query.
#pragma once
#include <cstdint>
#include <vector>

#include "mapping/types/image.hpp"

namespace roomradar {

inline constexpr int kMaxWindowRadius_px = 31;

/// Sparse table. At each pixel, nearest_m[k] stores the minimum depth of the 2^k x 2^k square whose upper
/// left corner is this pixel. The minimum is infinity if the square has no depth. Four such squares cover any
/// window whose side is at least 2^k and less than 2^(k+1).
struct DepthWindows {
  std::vector<DepthImage> nearest_m;
  Image<std::int32_t> measured;  ///< integral image: number of pixels with depth above and to the left
};

struct WindowDepth {
  float nearest_m = 0.0F;       ///< infinity if no pixel of the window has depth
  float measured_share = 0.0F;  ///< fraction of the window's pixels with depth; pixels outside the image
                                ///< count as pixels without depth
};

/// Builds the sparse table and the integral image, reusing the memory of `windows`.
void build_windows(const DepthImage& depth_m, DepthWindows& windows);

/// Queries the window of (2 radius_px + 1)^2 pixels around pixel (x, y). radius_px must be in
/// 0..kMaxWindowRadius_px. At the image's border, nearest_m may include some pixels just outside the window.
WindowDepth window_depth(const DepthWindows& windows, int x, int y, int radius_px);

}  // namespace roomradar
