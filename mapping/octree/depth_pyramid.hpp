// depth_pyramid.hpp: min/max pyramid of a depth image, bounding free and hidden space per pixel rectangle.
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

/// Half-width (m) of the truncation band around a surface measured at depth_m, in which signed distance is
/// kept.
float half_layer_m(float depth_m, double resolution_m, const FusionConfig& config);

/// Bounds along the optical axis over all pixels of a rectangle. Nearer than `front`, every pixel observes
/// free space. Nearer than `nearest`, every pixel with depth observes free space; pixels without depth are
/// ignored. Farther than -`behind`, every pixel is occluded or unmeasured. Between `front` and -`behind` may
/// be surface. Unit: 1 / steps_per_m of the pyramid, rounded conservatively. `behind` is negated so that a
/// rectangle's bounds are the minimum of its pixels' bounds in every field.
struct DepthBounds {
  std::int16_t front = 0;
  std::int16_t nearest = 0;
  std::int16_t behind = 0;
  std::int16_t unused = 0;
};

/// Level i has cells of 2^i x 2^i pixels, i = 1..levels. All levels are stacked in one array, so a cell's
/// index takes little arithmetic; array elements outside the levels are neutral.
struct DepthPyramid {
  float steps_per_m = 0.0F;
  int width_px = 0, height_px = 0;
  int levels = 0;
  int stride = 0;                                                   ///< cells per row of the array
  std::vector<DepthBounds> cells;                                   ///< 2^levels rows
  std::vector<float> row_nearest_m, row_farthest_m, row_deepest_m;  // scratch, for two rows of the image

  /// First row of a level: 0, 1/2, 3/4, ... of all rows.
  [[nodiscard]] int first_row(int level) const { return (1 << levels) - (2 << (levels - level)); }
  [[nodiscard]] DepthBounds* row(int level, int y) { return cells.data() + (first_row(level) + y) * stride; }
  [[nodiscard]] int cells_across(int level) const { return ((width_px - 1) >> level) + 1; }
  [[nodiscard]] int cells_down(int level) const { return ((height_px - 1) >> level) + 1; }
};

/// Builds the pyramid, reusing its memory. Pixels without depth prove nothing. A hole smaller than 4 x 4
/// pixels (2 x 2 in rectangles up to six pixels wide) takes its neighbours' bounds, so single dropouts do not
/// keep the space in front of a wall unknown. Pixels beyond max_range_m prove free space up to max_range_m.
void build_pyramid(const DepthImage& depth_m, double resolution_m, const FusionConfig& config,
                   DepthPyramid& pyramid);

/// Up to 4 x 4 cells of one level. The same number of cells is always read, some of them twice: a branch
/// would cost more.
struct CellRect {
  int at = 0;                           ///< index of the first cell
  int column = 0;                       ///< offset from the first column to the last but one, or 0
  int second = 0, third = 0, last = 0;  ///< offsets from the first row to these; third: last but one
};

/// Bounds over all of the cells.
inline DepthBounds bounds_within(const DepthPyramid& pyramid, const CellRect& rect) {
  using Pair = std::int16_t __attribute__((vector_size(2 * sizeof(DepthBounds))));  // two neighbouring cells
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
