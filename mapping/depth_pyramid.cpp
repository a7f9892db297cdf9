// depth_pyramid.cpp: building and asking the pyramid of depth bounds.
#include "mapping/depth_pyramid.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "mapping/types/depth_noise.hpp"

namespace roomradar {
namespace {

// Front of a pixel that leaves it to its neighbours.
constexpr float kNoWord = std::numeric_limits<float>::infinity();
constexpr int kHoleLevel = 2;  // cells of 4 x 4 pixels must hold some depth

DepthBounds merged(const DepthBounds& a, const DepthBounds& b) {
  return {std::min(a.front_m, b.front_m), std::max(a.back_m, b.back_m), std::min(a.nearest_m, b.nearest_m)};
}

void halve(const Image<DepthBounds>& fine, Image<DepthBounds>& coarse) {
  coarse.resize((fine.width + 1) / 2, (fine.height + 1) / 2);
  for (int y = 0; y < coarse.height; ++y) {
    const DepthBounds* upper = fine.row(2 * y);
    const DepthBounds* lower = fine.row(std::min(2 * y + 1, fine.height - 1));
    DepthBounds* out = coarse.row(y);
    for (int x = 0; x < fine.width / 2; ++x)
      out[x] = merged(merged(upper[2 * x], upper[2 * x + 1]), merged(lower[2 * x], lower[2 * x + 1]));
    if (fine.width % 2 == 1) out[coarse.width - 1] = merged(upper[fine.width - 1], lower[fine.width - 1]);
  }
}

}  // namespace

DepthBounds truncation_layer(float depth_m, double resolution_m, const FusionConfig& config) {
  const float half_m = std::max(config.truncation_voxels * static_cast<float>(resolution_m),
                                config.truncation_sigmas * depth_sigma_m(depth_m));
  return {depth_m - half_m, depth_m + half_m, depth_m - half_m};
}

void build_pyramid(const DepthImage& depth_m, double resolution_m, const FusionConfig& config,
                   DepthPyramid& pyramid) {
  const auto longest = static_cast<unsigned>(std::max({depth_m.width, depth_m.height, 1}));
  pyramid.levels.resize(static_cast<std::size_t>(std::bit_width(longest - 1)) + 1);
  Image<DepthBounds>& base = pyramid.levels.front();
  base.resize(depth_m.width, depth_m.height);
  for (std::size_t i = 0; i < depth_m.pixels.size(); ++i) {
    const float z = depth_m.pixels[i];
    if (!(z > 0.0F)) {
      base.pixels[i] = {kNoWord, 0.0F, kNoWord};
    } else if (z > config.max_range_m) {
      base.pixels[i] = {config.max_range_m, config.max_range_m, config.max_range_m};
    } else {
      base.pixels[i] = truncation_layer(z, resolution_m, config);
    }
  }
  for (std::size_t level = 1; level < pyramid.levels.size(); ++level) {
    halve(pyramid.levels[level - 1], pyramid.levels[level]);
    if (level != kHoleLevel) continue;
    for (DepthBounds& cell : pyramid.levels[level].pixels)
      if (cell.front_m == kNoWord) cell.front_m = 0.0F;
  }
}

DepthBounds bounds_within(const DepthPyramid& pyramid, int left, int top, int right, int bottom) {
  const auto span = static_cast<unsigned>(std::max(right - left, bottom - top));
  const int level =
      std::min(static_cast<int>(std::bit_width(span)), static_cast<int>(pyramid.levels.size()) - 1);
  const Image<DepthBounds>& cells = pyramid.levels[static_cast<std::size_t>(level)];
  const DepthBounds* upper = cells.row(top >> level);
  const DepthBounds* lower = cells.row(bottom >> level);
  return merged(merged(upper[left >> level], upper[right >> level]),
                merged(lower[left >> level], lower[right >> level]));
}

}  // namespace roomradar
