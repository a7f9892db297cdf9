// depth_pyramid.hpp: what a depth image proves about whole rectangles of its pixels.
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "mapping/fusion_config.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Signed distance is kept so far before and behind a surface measured at depth_m.
float half_layer_m(float depth_m, double resolution_m, const FusionConfig& config);

/// Of all pixels in a rectangle: what lies nearer than `front` along the optical axis is seen through by each
/// of them; what lies nearer than `nearest` is seen through by those that have depth, and the others say
/// nothing; what lies farther than -`behind` is hidden from, or unmeasured by, each of them. Between `front`
/// and -`behind` lies a surface. In steps of the pyramid's step_m, rounded to the safe side. `behind` counts
/// downwards so that a rectangle's bounds are the least of its pixels' in every field.
struct DepthBounds {
  std::int16_t front = 0;
  std::int16_t nearest = 0;
  std::int16_t behind = 0;
  std::int16_t unused = 0;
};

struct DepthPyramid {
  float steps_per_m = 0.0F;
  /// levels[i] has cells of 2^i pixels each way, and one more column that says nothing. levels[0] is not
  /// kept: single pixels are what the image is for.
  std::vector<Image<DepthBounds>> levels;
  std::vector<float> row_nearest_m, row_farthest_m, row_deepest_m;  // of two rows of the image
};

/// Pixels without depth prove nothing; a hole smaller than 4 x 4 pixels (2 x 2 in rectangles of six and less)
/// takes the word of its neighbours, so that single dropouts do not keep the space before a wall unknown.
/// Pixels past max_range_m prove free what is nearer than that. Reuses the pyramid's memory.
void build_pyramid(const DepthImage& depth_m, double resolution_m, const FusionConfig& config,
                   DepthPyramid& pyramid);

/// Of a rectangle (borders included) within the image: on the finest level where it spans at most four cells
/// each way.
inline DepthBounds bounds_within(const DepthPyramid& pyramid, int left, int top, int right, int bottom) {
  using Pair = std::int16_t __attribute__((vector_size(2 * sizeof(DepthBounds))));  // of neighbouring cells
  const auto span = static_cast<unsigned>(std::max(right - left, bottom - top));
  const int level = std::clamp(static_cast<int>(std::bit_width((span + 2) / 3 - (span > 0 ? 1 : 0))), 1,
                               static_cast<int>(pyramid.levels.size()) - 1);
  const Image<DepthBounds>& cells = pyramid.levels[static_cast<std::size_t>(level)];
  const auto pair_at = [](const DepthBounds* cell) {
    Pair pair;
    std::memcpy(&pair, cell, sizeof(pair));
    return pair;
  };
  const auto least = [](const Pair& a, const Pair& b) { return a < b ? a : b; };
  const int first = left >> level;
  const int second = std::max((right >> level) - 1, first);
  const int top_row = top >> level, last_row = bottom >> level;
  const auto in_row = [&](int y) {
    const DepthBounds* row = cells.pixels.data() + y * cells.width;
    return least(pair_at(row + first), pair_at(row + second));
  };
  // Always four rows, some of them the same: a branch would cost more.
  const Pair upper = least(in_row(top_row), in_row(std::min(top_row + 1, last_row)));
  const Pair both = least(upper, least(in_row(std::max(last_row - 1, top_row)), in_row(last_row)));
  const Pair bounds = least(both, __builtin_shufflevector(both, both, 4, 5, 6, 7, 0, 1, 2, 3));
  DepthBounds of_all;
  std::memcpy(static_cast<void*>(&of_all), &bounds, sizeof(of_all));
  return of_all;
}

}  // namespace roomradar
