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
constexpr int kBlock_px = 8;  // grid on which the reach into holes is computed
constexpr int kSlopeStep_px =
    4;  // slopes are taken over several pixels: a mesh from cells is a staircase at one

// Evidence of one pixel, as bits.
constexpr std::uint8_t kWeakMoved = 1, kStrongMoved = 2, kWeakRevealed = 4, kStrongRevealed = 8, kTaken = 16;

// Nearest and farthest expected depth within `radius` pixels along each row.
void extremes_along_rows(const DepthImage& expected_m, int radius, ForegroundScratch& scratch) {
  const int width = expected_m.width;
  std::vector<float>& padded_nearest = scratch.padded_nearest_m;
  std::vector<float>& padded_farthest = scratch.padded_farthest_m;
  padded_nearest.assign(static_cast<std::size_t>(width + 2 * radius), kNothing_m);
  padded_farthest.assign(static_cast<std::size_t>(width + 2 * radius), 0.0F);
  for (int y = 0; y < expected_m.height; ++y) {
    const float* expected = expected_m.row(y);
    float* nearest_in = padded_nearest.data() + radius;
    float* farthest_in = padded_farthest.data() + radius;
    for (int x = 0; x < width; ++x) {
      nearest_in[x] = expected[x] > 0.0F ? expected[x] : kNothing_m;
      farthest_in[x] = expected[x];
    }
    float* nearest = scratch.row_nearest_m.data() + expected_m.index(0, y);
    float* farthest = scratch.row_farthest_m.data() + expected_m.index(0, y);
    std::copy_n(nearest_in - radius, width, nearest);
    std::copy_n(farthest_in - radius, width, farthest);
    for (int shift = 1 - radius; shift <= radius; ++shift) {
      const float* a = nearest_in + shift;
      const float* b = farthest_in + shift;
      for (int x = 0; x < width; ++x) {
        nearest[x] = a[x] < nearest[x] ? a[x] : nearest[x];
        farthest[x] = b[x] > farthest[x] ? b[x] : farthest[x];
      }
    }
  }
}

// The same across rows, for row y: the extremes in the whole window.
void extremes_across_rows(int width, int height, int y, int radius, ForegroundScratch& scratch) {
  float* nearest = scratch.nearest_m.data();
  float* farthest = scratch.farthest_m.data();
  const auto row = [width](const std::vector<float>& image, int at) {
    return image.data() + static_cast<std::size_t>(at) * static_cast<std::size_t>(width);
  };
  const int first = std::max(y - radius, 0);
  const int last = std::min(y + radius, height - 1);
  std::copy_n(row(scratch.row_nearest_m, first), width, nearest);
  std::copy_n(row(scratch.row_farthest_m, first), width, farthest);
  for (int other = first + 1; other <= last; ++other) {
    const float* a = row(scratch.row_nearest_m, other);
    const float* b = row(scratch.row_farthest_m, other);
    for (int x = 0; x < width; ++x) {
      nearest[x] = a[x] < nearest[x] ? a[x] : nearest[x];
      farthest[x] = b[x] > farthest[x] ? b[x] : farthest[x];
    }
  }
}

// Nearest expected depth of each block of pixels and of the blocks within `reach_px` around it.
void nearest_in_reach(const DepthImage& expected_m, int reach_px, ForegroundScratch& scratch) {
  const int columns = (expected_m.width + kBlock_px - 1) / kBlock_px;
  const int rows = (expected_m.height + kBlock_px - 1) / kBlock_px;
  const auto blocks = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  scratch.block_nearest_m.assign(blocks, kNothing_m);
  for (int y = 0; y < expected_m.height; ++y) {
    const float* expected = expected_m.row(y);
    float* block = scratch.block_nearest_m.data() + static_cast<std::size_t>(y / kBlock_px) * columns;
    for (int x = 0; x < expected_m.width; ++x) {
      const float z = expected[x] > 0.0F ? expected[x] : kNothing_m;
      float& nearest = block[x / kBlock_px];
      nearest = z < nearest ? z : nearest;
    }
  }
  const int reach = (reach_px + kBlock_px - 1) / kBlock_px;
  scratch.block_reach_m.assign(blocks, kNothing_m);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      float& nearest = scratch.block_reach_m[static_cast<std::size_t>(y * columns + x)];
      for (int v = std::max(y - reach, 0); v <= std::min(y + reach, rows - 1); ++v) {
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, columns - 1); ++u) {
          nearest = std::min(nearest, scratch.block_nearest_m[static_cast<std::size_t>(v * columns + u)]);
        }
      }
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

// What one row of pixels says, before its neighbours are asked.
void weigh_row(const DepthImage& depth_m, const DepthImage& expected_m, int y, const Intrinsics& camera,
               const ForegroundConfig& config, ForegroundScratch& scratch) {
  const int width = depth_m.width;
  const float* live = depth_m.row(y);
  const float* expected = expected_m.row(y);
  const float* above = expected_m.row(std::max(y - kSlopeStep_px, 0));
  const float* below = expected_m.row(std::min(y + kSlopeStep_px, expected_m.height - 1));
  const float* nearest = scratch.nearest_m.data();
  const float* farthest = scratch.farthest_m.data();
  float* sigma = scratch.sigma_m.data();
  std::uint8_t* evidence = scratch.evidence.data() + depth_m.index(0, y);

  const float per_step = 1.0F / static_cast<float>(kSlopeStep_px);
  const auto fx = static_cast<float>(camera.fx_px);
  const auto fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px);
  const float v = static_cast<float>(y) - static_cast<float>(camera.cy_px);
  for (int x = 0; x < width; ++x) {
    const float z = expected[x];
    const float left = expected[std::max(x - kSlopeStep_px, 0)];
    const float right = expected[std::min(x + kSlopeStep_px, width - 1)];
    const float slope_u = flatter(z - left, right - z) * per_step;
    const float slope_v = flatter(z - above[x], below[x] - z) * per_step;
    // With depth z(u, v) the surface normal is (fx z_u, fy z_v, -(z + u z_u + v z_v)), u and v from the
    // principal point; its product with the viewing ray (u / fx, v / fy, 1) is -z.
    const float u = static_cast<float>(x) - cx;
    const float normal_x = fx * slope_u;
    const float normal_y = fy * slope_v;
    const float normal_z = z + u * slope_u + v * slope_v;
    const float normal2 = normal_x * normal_x + normal_y * normal_y + normal_z * normal_z;
    const float ray2 = u * u / (fx * fx) + v * v / (fy * fy) + 1.0F;
    const float cosine = std::min(z / std::sqrt(std::max(normal2 * ray2, 1e-12F)), 1.0F);
    const float sensor = depth_sigma_m(z, arc_cosine(cosine));
    const float model = config.model_sigma_m + config.model_sigma_per_m * z;
    sigma[x] = std::sqrt(sensor * sensor + model * model);
  }
  for (int x = 0; x < width; ++x) {
    const float weak_m = config.weak_sigmas * sigma[x];
    const float strong_m = config.strong_sigmas * sigma[x];
    const bool known = live[x] > 0.0F && expected[x] > 0.0F;
    const bool weak_moved = live[x] < expected[x] - weak_m;
    const bool strong_moved = live[x] < nearest[x] - strong_m;
    const bool weak_revealed = live[x] > expected[x] + weak_m;
    const bool strong_revealed = live[x] > farthest[x] + strong_m;
    const int bits = weak_moved * kWeakMoved | strong_moved * kStrongMoved | weak_revealed * kWeakRevealed |
                     strong_revealed * kStrongRevealed;
    evidence[x] = static_cast<std::uint8_t>(known ? bits : 0);
  }
  // Holes of the model: only what is nearer than all the model around can have moved.
  const int columns = (width + kBlock_px - 1) / kBlock_px;
  const float* reach = scratch.block_reach_m.data() + static_cast<std::size_t>(y / kBlock_px) * columns;
  for (int x = 0; x < width; ++x) {
    if (expected[x] > 0.0F || !(live[x] > 0.0F)) continue;
    const float z = reach[x / kBlock_px];
    if (z == kNothing_m) continue;
    const float model = config.model_sigma_m + config.model_sigma_per_m * z;
    const float sensor = depth_sigma_m(z);
    if (live[x] < z - config.strong_sigmas * std::sqrt(sensor * sensor + model * model)) {
      evidence[x] = kWeakMoved | kStrongMoved;
    }
  }
}

// Depth steps between neighbouring pixels of one surface: noise, and a plane seen at 80 degrees from its
// normal.
inline bool same_surface(float a_m, float b_m, float slope) {
  const float z = std::min(a_m, b_m);
  return std::abs(a_m - b_m) <= 4.0F * depth_sigma_m(z) + slope * z;
}

// Collects the region around a strong pixel: neighbours that are strong, or weak and on the same surface.
// Leaves it in scratch.region; returns its area in the world, as if it faced the camera (m2).
float grow_region(const DepthImage& depth_m, std::uint32_t seed, std::uint8_t weak, std::uint8_t strong,
                  const Intrinsics& camera, ForegroundScratch& scratch) {
  const auto width = static_cast<std::uint32_t>(depth_m.width);
  const auto height = static_cast<std::uint32_t>(depth_m.height);
  const float slope = 5.67F / static_cast<float>(std::min(camera.fx_px, camera.fy_px));
  std::uint32_t* region = scratch.region.data();
  std::size_t size = 0;
  float area = 0.0F;
  const auto take = [&](std::uint32_t pixel) {
    scratch.evidence[pixel] |= kTaken;
    region[size++] = pixel;
    area += depth_m.pixels[pixel] * depth_m.pixels[pixel];
  };
  take(seed);
  for (std::size_t next = 0; next < size; ++next) {
    const std::uint32_t pixel = region[next];
    const float z = depth_m.pixels[pixel];
    const auto visit = [&](std::uint32_t other) {
      const std::uint8_t evidence = scratch.evidence[other];
      if ((evidence & kTaken) != 0 || (evidence & (weak | strong)) == 0) return;
      if ((evidence & strong) != 0 || same_surface(z, depth_m.pixels[other], slope)) take(other);
    };
    const std::uint32_t x = pixel % width;
    if (x > 0) visit(pixel - 1);
    if (x + 1 < width) visit(pixel + 1);
    if (pixel >= width) visit(pixel - width);
    if (pixel + width < width * height) visit(pixel + width);
  }
  scratch.region_size = size;
  return area / static_cast<float>(camera.fx_px * camera.fy_px);
}

// Labels the regions of one kind that are large enough; returns how many pixels they have.
std::size_t label_regions(const DepthImage& depth_m, std::uint8_t weak, std::uint8_t strong, PixelLabel label,
                          const Intrinsics& camera, const ForegroundConfig& config,
                          ForegroundScratch& scratch, LabelImage& labels) {
  std::size_t labelled = 0;
  for (std::uint32_t seed = 0; seed < scratch.evidence.size(); ++seed) {
    if ((scratch.evidence[seed] & strong) == 0 || (scratch.evidence[seed] & kTaken) != 0) continue;
    const float area_m2 = grow_region(depth_m, seed, weak, strong, camera, scratch);
    if (scratch.region_size < static_cast<std::size_t>(config.min_region_px) ||
        area_m2 < config.min_region_m2) {
      continue;
    }
    for (std::size_t i = 0; i < scratch.region_size; ++i) labels.pixels[scratch.region[i]] = label;
    labelled += scratch.region_size;
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
  require(config.silhouette_px >= 0 && config.silhouette_px <= 64, "silhouette_px", config.silhouette_px,
          "in 0..64");
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
  scratch.row_nearest_m.resize(pixels);
  scratch.row_farthest_m.resize(pixels);
  scratch.nearest_m.resize(width);
  scratch.farthest_m.resize(width);
  scratch.sigma_m.resize(width);
  scratch.evidence.resize(pixels);
  scratch.region.resize(pixels);

  extremes_along_rows(expected_depth_m, config.silhouette_px, scratch);
  nearest_in_reach(expected_depth_m, config.hole_reach_px, scratch);
  for (int y = 0; y < depth_m.height; ++y) {
    extremes_across_rows(depth_m.width, depth_m.height, y, config.silhouette_px, scratch);
    weigh_row(depth_m, expected_depth_m, y, camera, config, scratch);
  }

  ForegroundCounts counts;
  for (std::size_t i = 0; i < pixels; ++i) {
    const bool live = depth_m.pixels[i] > 0.0F;
    const bool known = live && expected_depth_m.pixels[i] > 0.0F;
    labels.pixels[i] = known ? PixelLabel::kStatic : PixelLabel::kNotKnown;
    counts.valid += live;
  }
  counts.moved =
      label_regions(depth_m, kWeakMoved, kStrongMoved, PixelLabel::kMoved, camera, config, scratch, labels);
  counts.revealed = label_regions(depth_m, kWeakRevealed, kStrongRevealed, PixelLabel::kRevealed, camera,
                                  config, scratch, labels);
  for (std::size_t i = 0; i < pixels; ++i) {
    moved_mask.pixels[i] = labels.pixels[i] == PixelLabel::kMoved ? 255 : 0;
    counts.not_known += depth_m.pixels[i] > 0.0F && labels.pixels[i] == PixelLabel::kNotKnown;
  }
  return counts;
}

}  // namespace roomradar
