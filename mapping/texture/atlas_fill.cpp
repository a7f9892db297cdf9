// atlas_fill.cpp: push-pull.
#include "mapping/texture/atlas_fill.hpp"

#include <algorithm>

namespace roomradar {

void fill_gaps(ColourImage& atlas, const MaskImage& has_colour) {
  if (std::all_of(has_colour.pixels.begin(), has_colour.pixels.end(), [](auto mask) { return mask != 0; }))
    return;
  constexpr Rgb kGrey = {128, 128, 128};
  ColourImage half((atlas.width + 1) / 2, (atlas.height + 1) / 2, kGrey);
  MaskImage half_has(half.width, half.height);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      int r = 0, g = 0, b = 0, count = 0;
      for (int v = 2 * y; v < std::min(2 * y + 2, atlas.height); ++v)
        for (int u = 2 * x; u < std::min(2 * x + 2, atlas.width); ++u) {
          if (has_colour.at(u, v) == 0) continue;
          const Rgb& pixel = atlas.at(u, v);
          r += pixel.r;
          g += pixel.g;
          b += pixel.b;
          ++count;
        }
      if (count == 0) continue;
      half.at(x, y) = {static_cast<std::uint8_t>(r / count), static_cast<std::uint8_t>(g / count),
                       static_cast<std::uint8_t>(b / count)};
      half_has.at(x, y) = 255;
    }
  if (half.width < atlas.width || half.height < atlas.height) fill_gaps(half, half_has);
  for (int y = 0; y < atlas.height; ++y)
    for (int x = 0; x < atlas.width; ++x)
      if (has_colour.at(x, y) == 0) atlas.at(x, y) = half.at(x / 2, y / 2);
}

}  // namespace roomradar
