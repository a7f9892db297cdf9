// colour_map.hpp: maps numbers to colours.
#pragma once
#include <algorithm>
#include <array>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Returns the colour of the Viridis colour map for t in 0..1, from dark violet to yellow. Computed by
/// polynomials of degree six, fitted by Matt Zucker.
inline Rgb viridis(float t) {
  constexpr std::array<std::array<double, 7>, 3> kFit = {
      {{0.27772733, 0.10509304, -0.33086183, -4.63423050, 6.22826994, 4.77638500, -5.43545586},
       {0.00540734, 1.40461353, 0.21484756, -5.79910097, 14.17993337, -13.74514538, 4.64585261},
       {0.33409981, 1.38459016, 0.09509516, -19.33244096, 56.69055260, -65.35303263, 26.31243525}}};
  const double x = std::clamp(static_cast<double>(t), 0.0, 1.0);
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    double value = 0.0;
    for (std::size_t power = 7; power-- > 0;) value = value * x + kFit[channel][power];
    rgb[channel] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 1.0) * 255.0 + 0.5);
  }
  return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace roomradar
