// foreground.cpp: which pixels of a depth frame differ from the static model, and how.
#include "dynamic/foreground.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

constexpr float kNothing_m = std::numeric_limits<float>::max();  // "nearest" where the model has nothing
constexpr int kBlock_px = 4;   // extremes around a pixel are taken over whole blocks of this size
constexpr int kMaxWindow = 6;  // blocks to each side
// Slopes are taken over several pixels: a mesh from cells is a staircase at one.
constexpr int kSlopeStep_px = 4;

// Evidence of one pixel, as bits.
constexpr std::uint8_t kWeakMoved = 1, kStrongMoved = 2, kWeakRevealed = 4, kStrongRevealed = 8, kTaken = 16,
                       kDoubtful = 32;

int blocks_along(int size_px) { return (size_px + kBlock_px - 1) / kBlock_px; }

// Smallest (or largest) value of the blocks within `reach` blocks of each block, along rows and then along
// columns.
template <typename Better>
void spread(const std::vector<float>& blocks, int columns, int rows, int reach, const Better& better,
            ForegroundScratch& scratch) {
  std::vector<float>& along_rows = scratch.along_rows_m;
  std::vector<float>& spread_blocks = scratch.spread_m;
  const auto at = [columns](int x, int y) { return static_cast<std::size_t>(y) * columns + x; };
  along_rows = blocks;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      float best = blocks[at(x, y)];
      for (int u = std::max(x - reach, 0); u <= std::min(x + reach, columns - 1); ++u) {
        best = better(best, blocks[at(u, y)]);
      }
      along_rows[at(x, y)] = best;
    }
  }
  spread_blocks = along_rows;
  for (int y = 0; y < rows; ++y) {
    float* best = spread_blocks.data() + at(0, y);
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, rows - 1); ++v) {
      const float* other = along_rows.data() + at(0, v);
      for (int x = 0; x < columns; ++x) best[x] = better(best[x], other[x]);
    }
  }
}

// How many blocks to each side an edge may be off: the turn of the pose shifts all edges alike, its shift and
// the map's distortion the near ones more.
void choose_windows(int columns, int rows, const Intrinsics& camera, const ForegroundConfig& config,
                    ForegroundScratch& scratch) {
  const auto nearer = [](float a, float b) { return b < a ? b : a; };
  spread(scratch.block_nearest_m, columns, rows, kMaxWindow, nearer, scratch);
  const float focal_px = static_cast<float>(std::max(camera.fx_px, camera.fy_px));
  scratch.window.resize(scratch.block_nearest_m.size());
  for (std::size_t i = 0; i < scratch.window.size(); ++i) {
    const float edge_px = focal_px * (config.edge_error_rad + config.edge_error_m / scratch.spread_m[i]);
    scratch.window[i] = std::clamp(static_cast<int>(std::ceil(edge_px / kBlock_px)), 0, kMaxWindow);
  }
}

// Nearest and farthest expected depth around each block: within the silhouette's window, and within the
// hole's reach.
void extremes_around(const DepthImage& expected_m, const Intrinsics& camera, const ForegroundConfig& config,
                     ForegroundScratch& scratch) {
  const auto nearer = [](float a, float b) { return b < a ? b : a; };
  const auto farther = [](float a, float b) { return b > a ? b : a; };
  const int columns = blocks_along(expected_m.width);
  const int rows = blocks_along(expected_m.height);
  const auto width = static_cast<std::size_t>(columns) * kBlock_px;
  scratch.block_nearest_m.assign(static_cast<std::size_t>(columns) * rows, kNothing_m);
  scratch.block_farthest_m.assign(static_cast<std::size_t>(columns) * rows, 0.0F);
  for (int row = 0; row < rows; ++row) {
    scratch.nearest_m.assign(width, kNothing_m);
    scratch.farthest_m.assign(width, 0.0F);
    for (int y = row * kBlock_px; y < std::min((row + 1) * kBlock_px, expected_m.height); ++y) {
      const float* expected = expected_m.row(y);
      float* nearest = scratch.nearest_m.data();
      float* farthest = scratch.farthest_m.data();
      for (int x = 0; x < expected_m.width; ++x) {
        const float z = expected[x];
        nearest[x] = nearer(nearest[x], z > 0.0F ? z : kNothing_m);
        farthest[x] = farther(farthest[x], z);
      }
    }
    for (int column = 0; column < columns; ++column) {
      const std::size_t block = static_cast<std::size_t>(row) * columns + column;
      for (int x = column * kBlock_px; x < (column + 1) * kBlock_px; ++x) {
        scratch.block_nearest_m[block] = nearer(scratch.block_nearest_m[block], scratch.nearest_m[x]);
        scratch.block_farthest_m[block] = farther(scratch.block_farthest_m[block], scratch.farthest_m[x]);
      }
    }
  }
  choose_windows(columns, rows, camera, config, scratch);
  spread(scratch.block_nearest_m, columns, rows, blocks_along(config.hole_reach_px), nearer, scratch);
  scratch.window_reach_m = scratch.spread_m;
  scratch.grown_nearest_m = scratch.window_nearest_m = scratch.block_nearest_m;
  scratch.grown_farthest_m = scratch.window_farthest_m = scratch.block_farthest_m;
  for (int reach = 1; reach <= kMaxWindow; ++reach) {
    spread(scratch.grown_nearest_m, columns, rows, 1, nearer, scratch);
    scratch.grown_nearest_m.swap(scratch.spread_m);
    spread(scratch.grown_farthest_m, columns, rows, 1, farther, scratch);
    scratch.grown_farthest_m.swap(scratch.spread_m);
    for (std::size_t i = 0; i < scratch.window.size(); ++i) {
      if (scratch.window[i] != reach) continue;
      scratch.window_nearest_m[i] = scratch.grown_nearest_m[i];
      scratch.window_farthest_m[i] = scratch.grown_farthest_m[i];
    }
  }
}

// Angle of which `cosine` in 0..1 is the cosine, within 7e-5 rad, without a library call.
// Source: Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.45.
inline float arc_cosine(float cosine) {
  return std::sqrt(1.0F - cosine) *
         (1.5707288F + cosine * (-0.2121144F + cosine * (0.0742610F - 0.0187293F * cosine)));
}

// The flatter of two slopes, so that a depth jump on one side of a pixel does not count as a slope.
inline float flatter(float a, float b) { return std::abs(a) < std::abs(b) ? a : b; }

// Sensor's and model's error together, for a surface at depth_m.
inline float total_sigma_m(float depth_m, float incidence_rad, const ForegroundConfig& config) {
  const float sensor = depth_sigma_m(depth_m, incidence_rad);
  const float model = config.model_sigma_m + config.model_sigma_per_m * depth_m;
  return std::sqrt(sensor * sensor + model * model);
}

// sigma_m of each pixel of row y, from the expected depth and its slope.
void sigmas_of_row(const DepthImage& expected_m, int y, const Intrinsics& camera,
                   const ForegroundConfig& config, ForegroundScratch& scratch) {
  const int width = expected_m.width;
  const float* middle = expected_m.row(y);
  const float* above = expected_m.row(std::max(y - kSlopeStep_px, 0));
  const float* below = expected_m.row(std::min(y + kSlopeStep_px, expected_m.height - 1));
  float* padded = scratch.padded_m.data();
  std::copy_n(middle, width, padded + kSlopeStep_px);
  std::fill_n(padded, kSlopeStep_px, middle[0]);
  std::fill_n(padded + kSlopeStep_px + width, kSlopeStep_px, middle[width - 1]);

  const float* left = padded;
  const float* right = padded + 2 * kSlopeStep_px;
  float* sigma = scratch.sigma_m.data();
  const float per_step = 1.0F / static_cast<float>(kSlopeStep_px);
  const auto fx = static_cast<float>(camera.fx_px);
  const auto fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px);
  const float v = static_cast<float>(y) - static_cast<float>(camera.cy_px);
  const float v_ray2 = v * v / (fy * fy) + 1.0F;
  // A copy, so that the compiler sees that the loop does not write it.
  const ForegroundConfig settings = config;
  for (int x = 0; x < width; ++x) {
    // With depth z(u, v) the surface normal is (fx z_u, fy z_v, -(z + u z_u + v z_v)), u and v from the
    // principal point; its product with the viewing ray (u / fx, v / fy, 1) is -z.
    const float z = middle[x];
    const float u = static_cast<float>(x) - cx;
    const float slope_u = flatter(z - left[x], right[x] - z) * per_step;
    const float slope_v = flatter(z - above[x], below[x] - z) * per_step;
    const float normal_x = fx * slope_u;
    const float normal_y = fy * slope_v;
    const float normal_z = z + u * slope_u + v * slope_v;
    const float normal2 = normal_x * normal_x + normal_y * normal_y + normal_z * normal_z;
    const float cosine = z / std::sqrt(normal2 * (u * u / (fx * fx) + v_ray2) + 1e-12F);
    sigma[x] = total_sigma_m(z, arc_cosine(cosine < 1.0F ? cosine : 1.0F), settings);
  }
}

// What one row of pixels says, before its neighbours are asked.
void weigh_row(const DepthImage& depth_m, const DepthImage& expected_m, int y, const ForegroundConfig& config,
               ForegroundScratch& scratch) {
  const int width = depth_m.width;
  const float* live = depth_m.row(y);
  const float* expected = expected_m.row(y);
  const float* nearest = scratch.nearest_m.data();
  const float* farthest = scratch.farthest_m.data();
  const float* sigma = scratch.sigma_m.data();
  std::uint8_t* evidence = scratch.evidence.data() + depth_m.index(0, y);
  const float weak = config.weak_sigmas;
  const float strong = config.strong_sigmas;
  for (int x = 0; x < width; ++x) {
    const float z = live[x];
    const int moved = (z < expected[x] - weak * sigma[x] ? kWeakMoved : 0) |
                      (z < nearest[x] - strong * sigma[x] ? kStrongMoved : 0) |
                      (z < expected[x] - strong * sigma[x] ? kDoubtful : 0);
    const int revealed = (z > expected[x] + weak * sigma[x] ? kWeakRevealed : 0) |
                         (z > farthest[x] + strong * sigma[x] ? kStrongRevealed : 0);
    const int known = z > 0.0F ? (expected[x] > 0.0F ? 0xFF : 0) : 0;
    evidence[x] = static_cast<std::uint8_t>((moved | revealed) & known);
  }
  // Holes of the model: they prove nothing, but what moved may cover them.
  const float* reach = scratch.reach_m.data();
  for (int x = 0; x < width; ++x) {
    if (expected[x] > 0.0F || !(live[x] > 0.0F) || reach[x] == kNothing_m) continue;
    if (live[x] < reach[x] - strong * total_sigma_m(reach[x], 0.0F, config)) evidence[x] = kWeakMoved;
  }
}

// Whether an expected surface within the window around block (column, row) lies at depth_m, give or take. A
// block that holds an edge stands for its two sides, not for what is between them.
bool is_expected_near(float depth_m, int column, int row, int columns, int rows,
                      const ForegroundConfig& config, const ForegroundScratch& scratch) {
  const int reach = scratch.window[static_cast<std::size_t>(row) * columns + column];
  const float tolerance_m = config.strong_sigmas * total_sigma_m(depth_m, 0.0F, config);
  for (int v = std::max(row - reach, 0); v <= std::min(row + reach, rows - 1); ++v) {
    for (int u = std::max(column - reach, 0); u <= std::min(column + reach, columns - 1); ++u) {
      const std::size_t block = static_cast<std::size_t>(v) * columns + u;
      const float nearest = scratch.block_nearest_m[block];
      const float farthest = scratch.block_farthest_m[block];
      if (depth_m < nearest - tolerance_m || depth_m > farthest + tolerance_m) continue;
      if (farthest - nearest <= 2.0F * tolerance_m) return true;
      if (depth_m <= nearest + tolerance_m || depth_m >= farthest - tolerance_m) return true;
    }
  }
  return false;
}

// A pixel behind a near edge's reach, as of a ball behind a box, is no less moved if its depth is neither the
// near surface's nor the far one's.
void settle_doubts(const DepthImage& depth_m, int y, const ForegroundConfig& config,
                   ForegroundScratch& scratch) {
  std::uint8_t* evidence = scratch.evidence.data() + depth_m.index(0, y);
  const int columns = blocks_along(depth_m.width);
  const int rows = blocks_along(depth_m.height);
  for (int x = 0; x < depth_m.width; ++x) {
    if ((evidence[x] & (kDoubtful | kStrongMoved)) != kDoubtful) continue;
    if (!is_expected_near(depth_m.at(x, y), x / kBlock_px, y / kBlock_px, columns, rows, config, scratch)) {
      evidence[x] |= kStrongMoved;
    }
  }
}

// Repeats each block's value for the pixels of a row.
void stretch(const std::vector<float>& blocks, int columns, int row, std::vector<float>& pixels) {
  const float* block = blocks.data() + static_cast<std::size_t>(row) * columns;
  for (std::size_t x = 0; x < pixels.size(); ++x) pixels[x] = block[x / kBlock_px];
}

void weigh_pixels(const DepthImage& depth_m, const DepthImage& expected_m, const Intrinsics& camera,
                  const ForegroundConfig& config, ForegroundScratch& scratch) {
  const int columns = blocks_along(depth_m.width);
  for (int y = 0; y < depth_m.height; ++y) {
    if (y % kBlock_px == 0) {
      stretch(scratch.window_nearest_m, columns, y / kBlock_px, scratch.nearest_m);
      stretch(scratch.window_farthest_m, columns, y / kBlock_px, scratch.farthest_m);
      stretch(scratch.window_reach_m, columns, y / kBlock_px, scratch.reach_m);
    }
    sigmas_of_row(expected_m, y, camera, config, scratch);
    weigh_row(depth_m, expected_m, y, config, scratch);
    settle_doubts(depth_m, y, config, scratch);
  }
}

// Depth steps between neighbouring pixels of one surface: noise, and a plane seen at 80 degrees from its
// normal.
inline bool same_surface(float a_m, float b_m, float slope) {
  const float z = std::min(a_m, b_m);
  return std::abs(a_m - b_m) <= 4.0F * depth_sigma_m(z) + slope * z;
}

// One of the two ways to differ from the model.
struct Difference {
  std::uint8_t weak, strong;  // bits of evidence
  float min_strong_fraction;
  PixelLabel label;
};

struct Region {
  std::size_t pixels = 0;  // the first of scratch.region
  std::size_t strong_pixels = 0;
  float area_m2 = 0.0F;  // as if it faced the camera
};

// Collects the region around a strong pixel into scratch.region: neighbours that are strong, or weak and on
// the same surface.
Region grow_region(const DepthImage& depth_m, std::uint32_t seed, const Difference& difference,
                   int weak_reach_px, const Intrinsics& camera, ForegroundScratch& scratch) {
  const std::uint8_t weak = difference.weak;
  const std::uint8_t strong = difference.strong;
  const auto width = static_cast<std::uint32_t>(depth_m.width);
  const auto height = static_cast<std::uint32_t>(depth_m.height);
  const float slope = 5.67F / static_cast<float>(std::min(camera.fx_px, camera.fy_px));
  std::uint32_t* region = scratch.region.data();
  std::size_t size = 0;
  std::size_t strong_pixels = 0;
  float area = 0.0F;
  const auto take = [&](std::uint32_t pixel, int steps) {
    scratch.steps[pixel] = static_cast<std::uint8_t>(steps);
    strong_pixels += (scratch.evidence[pixel] & strong) != 0;
    scratch.evidence[pixel] |= kTaken;
    region[size++] = pixel;
    area += depth_m.pixels[pixel] * depth_m.pixels[pixel];
  };
  take(seed, 0);
  for (std::size_t next = 0; next < size; ++next) {
    const std::uint32_t pixel = region[next];
    const float z = depth_m.pixels[pixel];
    const int steps = scratch.steps[pixel] + 1;
    const auto visit = [&](std::uint32_t other) {
      const std::uint8_t evidence = scratch.evidence[other];
      if ((evidence & kTaken) != 0 || (evidence & (weak | strong)) == 0) return;
      if ((evidence & strong) != 0) {
        take(other, 0);
      } else if (steps <= weak_reach_px && same_surface(z, depth_m.pixels[other], slope)) {
        take(other, steps);
      }
    };
    const std::uint32_t x = pixel % width;
    if (x > 0) visit(pixel - 1);
    if (x + 1 < width) visit(pixel + 1);
    if (pixel >= width) visit(pixel - width);
    if (pixel + width < width * height) visit(pixel + width);
  }
  return {size, strong_pixels, area / static_cast<float>(camera.fx_px * camera.fy_px)};
}

// Labels the regions of one kind that are large enough; returns how many pixels they have.
std::size_t label_regions(const DepthImage& depth_m, const Difference& difference, const Intrinsics& camera,
                          const ForegroundConfig& config, ForegroundScratch& scratch, LabelImage& labels) {
  std::size_t labelled = 0;
  for (std::uint32_t seed = 0; seed < scratch.evidence.size(); ++seed) {
    if ((scratch.evidence[seed] & difference.strong) == 0 || (scratch.evidence[seed] & kTaken) != 0) continue;
    const Region region = grow_region(depth_m, seed, difference, config.weak_reach_px, camera, scratch);
    const float strong_fraction =
        static_cast<float>(region.strong_pixels) / static_cast<float>(region.pixels);
    if (region.pixels < static_cast<std::size_t>(config.min_region_px) ||
        region.area_m2 < config.min_region_m2 || strong_fraction < difference.min_strong_fraction) {
      continue;
    }
    for (std::size_t i = 0; i < region.pixels; ++i) labels.pixels[scratch.region[i]] = difference.label;
    labelled += region.pixels;
  }
  return labelled;
}

void require(bool holds, const char* field, double value, const char* rule) {
  if (!holds)
    throw Error("foreground." + std::string(field) + " = " + std::to_string(value) + ": must be " + rule);
}

}  // namespace

void require_valid(const ForegroundConfig& config) {
  require(config.model_sigma_m >= 0.0F && config.model_sigma_m < 1.0F, "model_sigma_m", config.model_sigma_m,
          "in 0..1");
  require(config.model_sigma_per_m >= 0.0F && config.model_sigma_per_m < 1.0F, "model_sigma_per_m",
          config.model_sigma_per_m, "in 0..1");
  require(config.weak_sigmas > 0.0F && config.weak_sigmas < 1e3F, "weak_sigmas", config.weak_sigmas,
          "in 0..1000");
  require(config.strong_sigmas >= config.weak_sigmas && config.strong_sigmas < 1e3F, "strong_sigmas",
          config.strong_sigmas, "at least weak_sigmas, and under 1000");
  require(config.edge_error_m >= 0.0F && config.edge_error_m < 1.0F, "edge_error_m", config.edge_error_m,
          "in 0..1");
  require(config.edge_error_rad >= 0.0F && config.edge_error_rad < 0.1F, "edge_error_rad",
          config.edge_error_rad, "in 0..0.1");
  require(config.min_strong_fraction >= 0.0F && config.min_strong_fraction <= 1.0F, "min_strong_fraction",
          config.min_strong_fraction, "in 0..1");
  require(config.min_strong_fraction_revealed >= 0.0F && config.min_strong_fraction_revealed <= 1.0F,
          "min_strong_fraction_revealed", config.min_strong_fraction_revealed, "in 0..1");
  require(config.weak_reach_px >= 0 && config.weak_reach_px <= 255, "weak_reach_px", config.weak_reach_px,
          "in 0..255");
  require(config.hole_reach_px >= 0 && config.hole_reach_px <= 256, "hole_reach_px", config.hole_reach_px,
          "in 0..256");
  require(config.min_region_px >= 0, "min_region_px", config.min_region_px, ">= 0");
  require(config.min_region_m2 >= 0.0F && std::isfinite(config.min_region_m2), "min_region_m2",
          config.min_region_m2, ">= 0");
}

ForegroundCounts mark_foreground(const DepthImage& depth_m, const DepthImage& expected_depth_m,
                                 const Intrinsics& camera, const ForegroundConfig& config,
                                 ForegroundScratch& scratch, LabelImage& labels, MaskImage& moved_mask) {
  assert(depth_m.width == expected_depth_m.width && depth_m.height == expected_depth_m.height);
  assert(depth_m.width == camera.width_px && depth_m.height == camera.height_px);
  const std::size_t pixels = depth_m.pixels.size();
  const auto width = static_cast<std::size_t>(depth_m.width);
  labels.resize(depth_m.width, depth_m.height, PixelLabel::kNotKnown);
  moved_mask.resize(depth_m.width, depth_m.height, 0);
  scratch.evidence.resize(pixels);
  scratch.steps.resize(pixels);
  scratch.region.resize(pixels);
  if (pixels == 0) return {};
  scratch.padded_m.resize(width + 2 * kSlopeStep_px);
  scratch.sigma_m.resize(width);
  scratch.reach_m.resize(width);
  extremes_around(expected_depth_m, camera, config, scratch);
  weigh_pixels(depth_m, expected_depth_m, camera, config, scratch);

  ForegroundCounts counts;
  for (std::size_t i = 0; i < pixels; ++i) {
    const bool live = depth_m.pixels[i] > 0.0F;
    const bool known = live && expected_depth_m.pixels[i] > 0.0F;
    labels.pixels[i] = known ? PixelLabel::kStatic : PixelLabel::kNotKnown;
    counts.valid += live;
  }
  const Difference moved{kWeakMoved, kStrongMoved, config.min_strong_fraction, PixelLabel::kMoved};
  const Difference revealed{kWeakRevealed, kStrongRevealed, config.min_strong_fraction_revealed,
                            PixelLabel::kRevealed};
  counts.moved = label_regions(depth_m, moved, camera, config, scratch, labels);
  counts.revealed = label_regions(depth_m, revealed, camera, config, scratch, labels);
  for (std::size_t i = 0; i < pixels; ++i) {
    moved_mask.pixels[i] = labels.pixels[i] == PixelLabel::kMoved ? 255 : 0;
    counts.not_known += depth_m.pixels[i] > 0.0F && labels.pixels[i] == PixelLabel::kNotKnown;
  }
  return counts;
}

}  // namespace roomradar
