// dynamic_pixels.cpp: converts mask and depth to bits, 64 pixels at a time.
#include "dynamic/surface/dynamic_pixels.hpp"

#include <algorithm>
#include <bit>
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
