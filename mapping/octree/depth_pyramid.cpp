// depth_pyramid.cpp: builds the pyramid of depth bounds.
#include "mapping/octree/depth_pyramid.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "mapping/octree/cell_levels.hpp"

namespace roomradar {
namespace {

constexpr float kNothing_m = std::numeric_limits<float>::infinity();
// Front of a cell without depth: neutral, so that the neighbours decide.
constexpr std::int16_t kNoWord = std::numeric_limits<std::int16_t>::max();
constexpr float kFarthestStep = 32'000.0F;
constexpr int kHoleLevel = 2;  // from this level on (4 x 4 pixels) cells must contain some depth

DepthBounds merged(const DepthBounds& a, const DepthBounds& b) {
  return {std::min(a.front, b.front), std::min(a.nearest, b.nearest), std::min(a.behind, b.behind),
          std::min(a.unused, b.unused)};
}

// Two adjacent rows of a depth image.
struct RowPair {
  const float* upper;
  const float* lower;
  int width;
};

// Computes the row of level-1 cells that two image rows give.
void bound_rows(const RowPair& rows, const TruncationBand& band, float max_range_m, DepthPyramid& pyramid,
                DepthBounds* cells) {
  const float* upper = rows.upper;
  const float* lower = rows.lower;
  const int width = rows.width;
  float* nearest = pyramid.row_nearest_m.data();    // min over the measured pixels
  float* farthest = pyramid.row_farthest_m.data();  // max over the pixels within max_range_m
  float* deepest = pyramid.row_deepest_m.data();    // max over all pixels
  for (int x = 0; x < width; ++x) {
    const float a = upper[x], b = lower[x];
    nearest[x] = std::min(a > 0.0F ? a : kNothing_m, b > 0.0F ? b : kNothing_m);
    farthest[x] = std::max(a <= max_range_m ? a : 0.0F, b <= max_range_m ? b : 0.0F);
    deepest[x] = std::max(a, b);
  }
  const float steps_per_m = pyramid.steps_per_m;
  for (int x = 0; x < (width + 1) / 2; ++x) {
    const float near_m = std::min(nearest[2 * x], nearest[2 * x + 1]);
    const float far_m = std::max(farthest[2 * x], farthest[2 * x + 1]);
    const bool past_range = std::max(deepest[2 * x], deepest[2 * x + 1]) > max_range_m;
    const float in_range_m = std::min(near_m, max_range_m);
    const float front_m = near_m > max_range_m ? max_range_m : in_range_m - band.widest_m(in_range_m);
    const float layer_end_m = far_m > 0.0F ? far_m + band.widest_m(far_m) : 0.0F;
    const float behind_m = std::max(layer_end_m, past_range ? max_range_m : 0.0F);
    const int front =
        near_m == kNothing_m ? kNoWord : static_cast<int>(std::max(front_m, 0.0F) * steps_per_m);
    const int behind = -static_cast<int>(behind_m * steps_per_m) - 1;
    cells[x] = {static_cast<std::int16_t>(front), static_cast<std::int16_t>(front),
                static_cast<std::int16_t>(behind), 0};
  }
}

void halve(DepthPyramid& pyramid, int level) {
  const int fine_across = pyramid.cells_across(level - 1), fine_down = pyramid.cells_down(level - 1);
  for (int y = 0; y < pyramid.cells_down(level); ++y) {
    const DepthBounds* upper = pyramid.row(level - 1, 2 * y);
    const DepthBounds* lower = pyramid.row(level - 1, std::min(2 * y + 1, fine_down - 1));
    DepthBounds* out = pyramid.row(level, y);
    for (int x = 0; x < fine_across / 2; ++x)
      out[x] = merged(merged(upper[2 * x], upper[2 * x + 1]), merged(lower[2 * x], lower[2 * x + 1]));
    if (fine_across % 2 == 1) out[fine_across / 2] = merged(upper[fine_across - 1], lower[fine_across - 1]);
  }
}

// From this level on, cells without any depth are no longer neutral: nothing is free there.
void block_holes(DepthPyramid& pyramid, int level) {
  for (int y = 0; y < pyramid.cells_down(level); ++y)
    for (int x = 0; x < pyramid.cells_across(level); ++x) {
      DepthBounds& cell = pyramid.row(level, y)[x];
      cell.front = cell.front == kNoWord ? std::int16_t{0} : cell.front;
    }
}

void resize(int width_px, int height_px, DepthPyramid& pyramid) {
  if (pyramid.width_px == width_px && pyramid.height_px == height_px) return;
  pyramid.width_px = width_px;
  pyramid.height_px = height_px;
  pyramid.levels = std::bit_width(static_cast<unsigned>(std::max({width_px, height_px, 2}) - 1));
  pyramid.stride = pyramid.cells_across(1) + 1;  // cells are read in pairs, also at the end of a row
  pyramid.cells.assign((std::size_t{1} << pyramid.levels) * static_cast<std::size_t>(pyramid.stride),
                       {kNoWord, kNoWord, kNoWord, kNoWord});
  const auto even_width = 2 * static_cast<std::size_t>(pyramid.cells_across(1));
  pyramid.row_nearest_m.assign(even_width, kNothing_m);
  pyramid.row_farthest_m.assign(even_width, 0.0F);
  pyramid.row_deepest_m.assign(even_width, 0.0F);
}

}  // namespace

TruncationBand::TruncationBand(double resolution_m, const FusionConfig& config)
    : voxels_(config.truncation_voxels),
      sigmas_(config.truncation_sigmas),
      voxel_m_(static_cast<float>(resolution_m)),
      // A surface that is nearer by the band's half-width may be in a coarse cell's band.
      coarse_from_m_(coarse_from_m(resolution_m, config) - 2.0F * voxels_ * voxel_m_),
      noise_(config.noise),
      most_m_(
          std::max(2.0F * voxels_ * voxel_m_, sigmas_ * depth_sigma_m(DepthNoise{}, config.max_range_m))) {}

void build_pyramid(const DepthImage& depth_m, double resolution_m, const FusionConfig& config,
                   DepthPyramid& pyramid) {
  const TruncationBand band(resolution_m, config);
  pyramid.steps_per_m = kFarthestStep / (config.max_range_m + band.widest_m(config.max_range_m));
  resize(depth_m.width, depth_m.height, pyramid);
  for (int y = 0; y < pyramid.cells_down(1); ++y)
    bound_rows({depth_m.row(2 * y), depth_m.row(std::min(2 * y + 1, depth_m.height - 1)), depth_m.width},
               band, config.max_range_m, pyramid, pyramid.row(1, y));
  for (int level = 2; level <= pyramid.levels; ++level) {
    halve(pyramid, level);
    if (level <= kHoleLevel) block_holes(pyramid, level - 1);
    if (level == kHoleLevel) block_holes(pyramid, level);
  }
}

}  // namespace roomradar
