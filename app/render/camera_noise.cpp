// camera_noise.cpp: measures noise by second differences; generates grain by hashing the pixel's index.
#include "app/render/camera_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

constexpr int kBlock_px = 16, kStep_px = 3;

int brightness(const Rgb& pixel) { return int{pixel.r} + int{pixel.g} + int{pixel.b}; }

/// Returns the mean absolute difference of second differences in a block; unset if it is saturated or black.
std::optional<float> roughness(const ColourImage& image, int x0, int y0) {
  constexpr int kBlack = 5, kSaturated = 250;
  int sum = 0, count = 0;
  for (int y = y0 + 1; y < y0 + kBlock_px - 1; y += kStep_px) {
    const Rgb *above = image.row(y - 1), *row = image.row(y), *below = image.row(y + 1);
    for (int x = x0 + 1; x < x0 + kBlock_px - 1; x += kStep_px) {
      const auto [least, most] = std::minmax({row[x].r, row[x].g, row[x].b});
      if (least < kBlack || most > kSaturated) return std::nullopt;
      const auto across = [x](const Rgb* of) {
        return brightness(of[x - 1]) - 2 * brightness(of[x]) + brightness(of[x + 1]);
      };
      sum += std::abs(across(above) - 2 * across(row) + across(below));
      ++count;
    }
  }
  return static_cast<float>(sum) / static_cast<float>(count);
}

}  // namespace

std::optional<float> noise_of(const ColourImage& image) {
  constexpr std::size_t kFewest = 20;
  // Mean of |N(0, 1)|, gain of the filter, three channels; the smoothest fifth of blocks of 25 independent
  // samples is this much below their mean.
  constexpr float kOfDeviation = 0.79788F * 6.0F * 3.0F, kSmoothest = 0.87F;
  std::vector<float> blocks;
  for (int y = 0; y + kBlock_px <= image.height; y += 2 * kBlock_px)
    for (int x = 0; x + kBlock_px <= image.width; x += kBlock_px)
      if (const auto rough = roughness(image, x, y)) blocks.push_back(*rough);
  if (blocks.size() < kFewest) return std::nullopt;
  const auto fifth = blocks.begin() + static_cast<std::ptrdiff_t>(blocks.size() / 5);
  std::nth_element(blocks.begin(), fifth, blocks.end());
  return *fifth / (kOfDeviation * kSmoothest);
}

void add_grain(const ObjectLayer& layer, const Occlusion& occlusion, float deviation, std::uint64_t seed,
               ColourImage& picture) {
  if (!(deviation > 0.0F)) return;
  const float part_a_sample = 1.0F / static_cast<float>(layer.samples * layer.samples);
  for (int y = 0; y < layer.rect.height; ++y) {
    for (int x = 0; x < layer.rect.width; ++x) {
      const int u = layer.rect.x + x, v = layer.rect.y + y;
      float covered = 0.0F;
      for (int j = 0; j < layer.samples; ++j)
        for (int i = 0; i < layer.samples; ++i)
          if (layer.depth_m.at(x * layer.samples + i, y * layer.samples + j) > 0.0F) covered += part_a_sample;
      const float visible =
          covered * (1.0F - occlusion.hidden.at(u - occlusion.rect.x, v - occlusion.rect.y));
      if (visible == 0.0F) continue;
      const float grain = visible * deviation * gaussian(mixed((seed << 32U) ^ picture.index(u, v)));
      const auto grainy = [grain](std::uint8_t of) {
        return static_cast<std::uint8_t>(
            std::clamp(std::floor(static_cast<float>(of) + grain + 0.5F), 0.0F, 255.0F));
      };
      Rgb& pixel = picture.at(u, v);
      pixel = {grainy(pixel.r), grainy(pixel.g), grainy(pixel.b)};
    }
  }
}

}  // namespace roomradar
