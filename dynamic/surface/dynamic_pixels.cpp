// dynamic_pixels.cpp: converts mask and depth to bits, 64 pixels at a time.
#include "dynamic/surface/dynamic_pixels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace roomradar {
namespace {

constexpr float kFarthest_m = 1e4F;

bool is_all_zero(const std::uint8_t* mask, int count) {
  if (count < 64) return std::all_of(mask, mask + count, [](std::uint8_t m) { return m == 0; });
  std::uint64_t any = 0;
  for (int i = 0; i < 8; ++i) {
    std::uint64_t eight;
    std::memcpy(&eight, mask + 8 * i, sizeof eight);
    any |= eight;
  }
  return any == 0;
}

std::uint64_t take_word(const std::uint8_t* mask, const float* depth_m, int count, float* inverse_depth) {
  for (int i = 0; i < count; ++i) inverse_depth[i] = 1.0F / depth_m[i];
  std::uint64_t word = 0;
  for (int i = 0; i < count; ++i) {
    const bool is_in = mask[i] != 0 && depth_m[i] > 0.0F && depth_m[i] < kFarthest_m;
    word |= std::uint64_t{is_in} << i;
  }
  return word;
}

/// Sets the unmeasured pixels between pixel (x, y) and the next dynamic pixel along (dx, dy), if these are at
/// most kMostGap_px pixels on one surface, which goes on at one end. Two specks are no surface. A plane's
/// inverse depth is linear between the two.
void bridge(const DepthImage& depth_m, int x, int y, int dx, int dy, DynamicPixels& pixels) {
  constexpr int kMostGap_px = 4;
  constexpr float kOneSurface = 0.03F;  // max relative difference of depth
  int apart = 1;
  const auto is_unmeasured = [&](int u, int v) {
    return depth_m.contains(u, v) && !(depth_m.at(u, v) > 0.0F) && !pixels.measured.at(u, v);
  };
  while (apart <= kMostGap_px && is_unmeasured(x + apart * dx, y + apart * dy)) ++apart;
  const int end_x = x + apart * dx, end_y = y + apart * dy;
  if (apart == 1 || !depth_m.contains(end_x, end_y) || !pixels.measured.at(end_x, end_y)) return;
  const float here = pixels.inverse_depth[depth_m.index(x, y)];
  const float there = pixels.inverse_depth[depth_m.index(end_x, end_y)];
  if (std::abs(here - there) > kOneSurface * std::min(here, there)) return;
  if (!pixels.measured.at(x - dx, y - dy) && !pixels.measured.at(end_x + dx, end_y + dy)) return;
  for (int k = 1; k < apart; ++k) {
    const int u = x + k * dx, v = y + k * dy;
    pixels.measured.row(v)[u >> 6] |= std::uint64_t{1} << (u & 63);
    pixels.inverse_depth[depth_m.index(u, v)] =
        here + (there - here) * static_cast<float>(k) / static_cast<float>(apart);
  }
}

/// Bridges narrow gaps without depth, along rows and then along columns.
void bridge_gaps(const DepthImage& depth_m, DynamicPixels& pixels) {
  const auto visit = [&](int y, int i, std::uint64_t ends, int dx, int dy) {
    for (; ends != 0; ends &= ends - 1) bridge(depth_m, 64 * i + std::countr_zero(ends), y, dx, dy, pixels);
  };
  for (int y = 0; y < depth_m.height; ++y) {
    for (int i = 0; i < pixels.measured.words; ++i) {
      const std::uint64_t* word = pixels.measured.row(y) + i;
      visit(y, i, word[0] & ~(word[0] >> 1 | word[1] << 63), 1, 0);
    }
  }
  for (int y = 0; y + 1 < depth_m.height; ++y)
    for (int i = 0; i < pixels.measured.words; ++i)
      visit(y, i, pixels.measured.row(y)[i] & ~pixels.measured.row(y + 1)[i], 0, 1);
}

/// Sets a pixel of `smooth` that is not measured to the mean of its measured neighbours.
void fill(int x, int y, DynamicPixels& pixels) {
  float sum = 0.0F;
  int count = 0;
  const auto width = static_cast<std::ptrdiff_t>(pixels.smooth.width);
  float* here = pixels.inverse_depth.data() + y * width + x;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (!pixels.measured.at(x + dx, y + dy)) continue;
      sum += here[dy * width + dx];
      ++count;
    }
  }
  *here = sum / static_cast<float>(std::max(count, 1));
}

}  // namespace

void take_dynamic_pixels(const DepthImage& depth_m, const MaskImage& dynamic_mask, DynamicPixels& pixels) {
  constexpr std::size_t kReadPast = 8;  // plane fitting reads eight pixels where it needs five
  pixels.inverse_depth.resize(depth_m.pixels.size() + kReadPast);
  pixels.measured.resize(depth_m.width, depth_m.height);
  for (int y = 0; y < depth_m.height; ++y) {
    const std::uint8_t* mask = dynamic_mask.row(y);
    const std::size_t first = depth_m.index(0, y);
    for (int x = 0; x < depth_m.width; x += 64) {
      const int count = std::min(64, depth_m.width - x);
      if (is_all_zero(mask + x, count)) continue;
      const std::size_t at = first + static_cast<std::size_t>(x);
      pixels.measured.row(y)[x >> 6] =
          take_word(mask + x, depth_m.pixels.data() + at, count, pixels.inverse_depth.data() + at);
    }
  }
  bridge_gaps(depth_m, pixels);
  take_majority(pixels.measured, pixels.smooth);
  take_far_from(pixels.measured, pixels.smooth, pixels.thin);
  for (int y = 0; y < depth_m.height; ++y) {
    for (int i = 0; i < pixels.smooth.words; ++i) {
      for (std::uint64_t added = pixels.smooth.row(y)[i] & ~pixels.measured.row(y)[i]; added != 0;
           added &= added - 1) {
        fill(64 * i + std::countr_zero(added), y, pixels);
      }
    }
  }
}

}  // namespace roomradar
