// depth_pyramid.hpp: min/max pyramid of a depth image, which bounds free and occluded space in the frustum of
// a pixel rectangle.
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "mapping/octree/fusion_config.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Half-widths of the truncation band. Signed distances are fused within this distance in front of and behind
/// a measured surface. The half-width is at most that of a Kinect v1 at FusionConfig::max_range_m, or
/// truncation_voxels coarse cells, whichever is larger.
class TruncationBand {
 public:
  TruncationBand(double resolution_m, const FusionConfig& config);
  /// Returns the half-width of the band for cells with an edge of cell_m, m.
  [[nodiscard]] float half_width_m(float depth_m, float cell_m) const {
    return std::min(std::max(voxels_ * cell_m, sigmas_ * depth_sigma_m(noise_, depth_m)), most_m_);
  }
  /// Returns the half-width of the widest band of cells at depth_m or near it, m.
  [[nodiscard]] float widest_m(float depth_m) const {
    return half_width_m(depth_m, depth_m < coarse_from_m_ ? voxel_m_ : 2.0F * voxel_m_);
  }

 private:
  float voxels_, sigmas_, voxel_m_, coarse_from_m_;
  DepthNoise noise_;
  float most_m_;  ///< max distance that the octree can store
};

/// Bounds of the depth, along the optical axis, over all pixels of a rectangle. Space nearer than `front` is
/// free along every pixel's ray. Space nearer than `nearest` is free along the rays of all pixels with depth.
/// Space farther than -`behind` is occluded or unmeasured along every ray. A surface is possible only between
/// `front` and -`behind`. The unit is 1 / DepthPyramid::steps_per_m, rounded conservatively. `behind` is
/// stored negated, so that each bound of a rectangle is the minimum of that bound over its pixels.
struct DepthBounds {
  std::int16_t front = 0;
  std::int16_t nearest = 0;
  std::int16_t behind = 0;
  std::int16_t unused = 0;
};

/// Pyramid of DepthBounds. Level i has cells of 2^i x 2^i pixels, i = 1..levels. All levels are stacked in
/// one array, so a cell's index is cheap to compute. Unused array elements hold the largest value and do not
/// affect a minimum.
struct DepthPyramid {
  float steps_per_m = 0.0F;
  int width_px = 0, height_px = 0;
  int levels = 0;
  int stride = 0;                  ///< number of cells per row of the array
  std::vector<DepthBounds> cells;  ///< the array: 2^levels rows of `stride` cells
  std::vector<float> row_nearest_m, row_farthest_m, row_deepest_m;  // scratch for two rows of the image

  /// Returns the first row of a level in the array. Level 1 begins at row 0, level 2 at half of all rows,
  /// level 3 at three quarters, and so on.
  [[nodiscard]] int first_row(int level) const { return (1 << levels) - (2 << (levels - level)); }
  [[nodiscard]] DepthBounds* row(int level, int y) { return cells.data() + (first_row(level) + y) * stride; }
  [[nodiscard]] int cells_across(int level) const { return ((width_px - 1) >> level) + 1; }
  [[nodiscard]] int cells_down(int level) const { return ((height_px - 1) >> level) + 1; }
};

/// Builds the pyramid, reusing its memory. Pixels without depth mark no space as free or occluded. Small gaps
/// are filled with the bounds of the pixels around them, so that single dropouts do not leave the space in
/// front of a wall unknown. A gap is small if it is below 4 x 4 pixels, or below 2 x 2 for query rectangles
/// of up to seven pixels per side. A pixel whose depth exceeds max_range_m makes space free up to
/// max_range_m.
void build_pyramid(const DepthImage& depth_m, double resolution_m, const FusionConfig& config,
                   DepthPyramid& pyramid);

/// Rectangle of up to 4 x 4 cells of one level, as offsets into the pyramid's array. bounds_within() always
/// reads eight pairs of neighbouring cells, some of them twice. A branch would cost more.
struct CellRect {
  int at = 0;      ///< index of the first cell in the array
  int column = 0;  ///< offset from the first pair of columns to the last pair; 0 if there is one pair
  /// Offsets in the array from the rectangle's first row to its second (`second`), last but one (`third`) and
  /// last row.
  int second = 0, third = 0, last = 0;
};

/// Returns the bounds over all cells of the rectangle.
inline DepthBounds bounds_within(const DepthPyramid& pyramid, const CellRect& rect) {
  // Bounds of two neighbouring cells.
  using Pair = std::int16_t __attribute__((vector_size(2 * sizeof(DepthBounds))));
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
