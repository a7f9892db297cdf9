// depth_pyramid.hpp: what a depth image proves about whole rectangles of its pixels.
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "mapping/octree/fusion_config.hpp"
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

/// Level i has cells of 2^i pixels each way, i = 1..levels. All stand below each other in one sheet, so that
/// a cell's place is found by a little arithmetic; what is in the sheet beside them says nothing.
struct DepthPyramid {
  float steps_per_m = 0.0F;
  int width_px = 0, height_px = 0;
  int levels = 0;
  int stride = 0;                                                   ///< cells from one row to the next
  std::vector<DepthBounds> cells;                                   ///< 2^levels rows
  std::vector<float> row_nearest_m, row_farthest_m, row_deepest_m;  // of two rows of the image

  /// The first row of a level: 0, 1/2, 3/4, ... of all.
  [[nodiscard]] int first_row(int level) const { return (1 << levels) - (2 << (levels - level)); }
  [[nodiscard]] DepthBounds* row(int level, int y) { return cells.data() + (first_row(level) + y) * stride; }
  [[nodiscard]] int cells_across(int level) const { return ((width_px - 1) >> level) + 1; }
  [[nodiscard]] int cells_down(int level) const { return ((height_px - 1) >> level) + 1; }
};

/// Pixels without depth prove nothing; a hole smaller than 4 x 4 pixels (2 x 2 in rectangles of six and less)
/// takes the word of its neighbours, so that single dropouts do not keep the space before a wall unknown.
/// Pixels past max_range_m prove free what is nearer than that. Reuses the pyramid's memory.
void build_pyramid(const DepthImage& depth_m, double resolution_m, const FusionConfig& config,
                   DepthPyramid& pyramid);

/// Up to 4 x 4 cells of one level. Always so many are looked at, some of them twice: a branch would cost
/// more.
struct CellRect {
  int at = 0;                           ///< place of the first in the sheet
  int column = 0;                       ///< from the first to the last but one across, or 0
  int second = 0, third = 0, last = 0;  ///< from the first row to the second, the last but one, the last
};

/// The bounds of all that is in the cells.
inline DepthBounds bounds_within(const DepthPyramid& pyramid, const CellRect& rect) {
  using Pair = std::int16_t __attribute__((vector_size(2 * sizeof(DepthBounds))));  // of neighbouring cells
  const DepthBounds* first = pyramid.cells.data() + rect.at;
  const auto least = [](const Pair& a, const Pair& b) { return a < b ? a : b; };
  const auto in_row = [&](int row) {
    Pair left, right;
    std::memcpy(&left, first + row, sizeof(left));
    std::memcpy(&right, first + row + rect.column, sizeof(right));
    return least(left, right);
  };
  const Pair both =
      least(least(in_row(0), in_row(rect.second)), least(in_row(rect.third), in_row(rect.last)));
  const Pair bounds = least(both, __builtin_shufflevector(both, both, 4, 5, 6, 7, 0, 1, 2, 3));
  DepthBounds of_all;
  std::memcpy(static_cast<void*>(&of_all), &bounds, sizeof(of_all));
  return of_all;
}

}  // namespace roomradar
