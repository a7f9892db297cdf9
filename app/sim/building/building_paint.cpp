// building_paint.cpp: draws hues from hashes.
#include "app/sim/building/building_paint.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

/// Returns a colour of this hue (0 to 1), saturation and value.
Rgb hsv(double hue, double saturation, double value) {
  const auto part = [&](double shift) {
    const double k = std::fmod(shift + 6.0 * hue, 6.0);
    const double of = value - value * saturation * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(255.0 * of));
  };
  return {part(5.0), part(3.0), part(1.0)};
}

}  // namespace

WallPaint wall_paint(std::uint64_t seed, std::uint32_t look) {
  CounterRandom random(seed, 1);
  const double hue = random.uniform(), strength = random.uniform(0.25, 0.6),
               value = random.uniform(0.55, 0.85);
  const double other = random.uniform(0.1, 0.9), warm = random.uniform();
  constexpr std::array kDados{Pattern::kFabric, Pattern::kTiles, Pattern::kPlanks, Pattern::kStone};
  const Pattern pattern = kDados[static_cast<std::size_t>(4.0 * random.uniform())];
  return {{pattern, hsv(hue, strength, value), hsv(std::fmod(hue + 0.15 * other, 1.0), strength, 0.6 * value),
           look + 500, 0.55F},
          {Pattern::kPlaster, hsv(warm, 0.07, 0.93), hsv(hue, 0.16, 0.8), look + 600, 0.62F}};
}

Material floor_covering(std::uint64_t seed, std::uint32_t look) {
  CounterRandom random(seed, 2);
  constexpr std::array kFloors{Pattern::kTiles, Pattern::kPlanks, Pattern::kStone, Pattern::kTiles};
  const Pattern pattern = kFloors[static_cast<std::size_t>(4.0 * random.uniform())];
  const double hue = random.uniform(), value = random.uniform(0.5, 0.85);
  return {pattern, hsv(hue, 0.22, value), hsv(hue, 0.3, 0.55 * value), look, 0.55F};
}

Material lacquer(std::uint64_t seed, std::uint32_t look) {
  CounterRandom random(seed, 3);
  const double hue = random.uniform(), value = random.uniform(0.45, 0.9);
  return {Pattern::kPortable, hsv(hue, 0.65, value), hsv(hue, 0.65, 0.7 * value), look, 0.5F};
}

Material picture_of(std::uint32_t look) {
  CounterRandom random(look, 4);
  const double hue = random.uniform(), kind = random.uniform();
  if (kind < 0.3) return {Pattern::kLandscape, hsv(0.5 + 0.2 * hue, 0.4, 0.85), {90, 128, 60}, look, 0.6F};
  return {Pattern::kPoster, hsv(hue, 0.15, 0.92), hsv(std::fmod(hue + 0.4, 1.0), 0.7, 0.45), look, 0.6F};
}

Material frame_of(std::uint32_t look) {
  CounterRandom random(look, 5);
  const double value = random.uniform(0.2, 0.8);
  return {Pattern::kWood, hsv(0.08, 0.4, value), hsv(0.08, 0.5, 0.6 * value), look + 1, 0.5F};
}

}  // namespace roomradar
