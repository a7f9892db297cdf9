// light_bench_pictures.cpp: compares pixels of pictures.
#include "light_bench_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

namespace roomradar {

int difference(const Rgb& a, const Rgb& b) {
  return std::abs(int{a.r} - int{b.r}) + std::abs(int{a.g} - int{b.g}) + std::abs(int{a.b} - int{b.b});
}

std::vector<std::size_t> object_pixels(const ExactView& exact, std::size_t object_begin) {
  std::vector<std::size_t> pixels;
  const auto is_object = [&](int x, int y) { return exact.solid.at(x, y) >= static_cast<int>(object_begin); };
  for (int y = 1; y + 1 < exact.solid.height; ++y)
    for (int x = 1; x + 1 < exact.solid.width; ++x) {
      bool whole = true;
      for (int v = -1; v <= 1 && whole; ++v)
        for (int u = -1; u <= 1 && whole; ++u) whole = is_object(x + u, y + v);
      if (whole) pixels.push_back(exact.solid.index(x, y));
    }
  return pixels;
}

double mean_difference(const ColourImage& a, const ColourImage& b, const std::vector<std::size_t>& pixels) {
  double sum = 0.0;
  for (const std::size_t i : pixels) sum += difference(a.pixels[i], b.pixels[i]);
  return pixels.empty() ? 0.0 : sum / (3.0 * static_cast<double>(pixels.size()));
}

double tile_change(const ColourImage& a, const ColourImage& b, const std::vector<std::size_t>& pixels) {
  constexpr std::size_t kTile_px = 16;
  std::map<std::size_t, std::pair<double, double>> tiles;  // sum of changes, number of pixels
  for (const std::size_t i : pixels) {
    const auto width = static_cast<std::size_t>(a.width);
    auto& [sum, count] = tiles[i / width / kTile_px * width + i % width / kTile_px];
    const Rgb &before = a.pixels[i], &after = b.pixels[i];
    sum += (int{after.r} + int{after.g} + int{after.b} - int{before.r} - int{before.g} - int{before.b}) / 3.0;
    count += 1.0;
  }
  double changed = 0.0;
  for (const auto& [tile, of] : tiles) changed += std::abs(of.first);
  return pixels.empty() ? 0.0 : changed / static_cast<double>(pixels.size());
}

double noise_in(const ColourImage& picture, const std::vector<std::size_t>& pixels) {
  constexpr double kOfDeviation = 0.6745 * 6.0 * 3.0;
  std::vector<int> rough;
  for (const std::size_t i : pixels) {
    const auto across = [](const Rgb* of) {
      const auto sum = [](const Rgb& pixel) { return int{pixel.r} + int{pixel.g} + int{pixel.b}; };
      return sum(of[-1]) - 2 * sum(of[0]) + sum(of[1]);
    };
    const Rgb* at = picture.pixels.data() + i;
    rough.push_back(std::abs(across(at - picture.width) - 2 * across(at) + across(at + picture.width)));
  }
  if (rough.empty()) return 0.0;
  const auto middle = rough.begin() + static_cast<std::ptrdiff_t>(rough.size() / 2);
  std::nth_element(rough.begin(), middle, rough.end());
  return *middle / kOfDeviation;
}

}  // namespace roomradar
