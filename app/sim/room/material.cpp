// material.cpp: computes wood, tiles, carpets, posters etc. from hashed noise, in metres of surface.
#include "app/sim/room/material.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Colour = std::array<float, 3>;
constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;

Colour colour_of(Rgb rgb) { return {rgb.r / 255.0F, rgb.g / 255.0F, rgb.b / 255.0F}; }
Colour mixed_colour(const Colour& a, const Colour& b, float part_of_b) {
  Colour mix;
  for (std::size_t i = 0; i < 3; ++i) mix[i] = a[i] + part_of_b * (b[i] - a[i]);
  return mix;
}
Colour brighter(const Colour& colour, float factor) {
  return {colour[0] * factor, colour[1] * factor, colour[2] * factor};
}

std::uint32_t cell_hash(int x, int y, std::uint32_t seed) {
  std::uint32_t h = seed * 0x9e3779b1U ^ static_cast<std::uint32_t>(x) * 0x85ebca77U ^
                    static_cast<std::uint32_t>(y) * 0xc2b2ae3dU;
  h = (h ^ (h >> 15)) * 0x2c1b3c6dU;
  h = (h ^ (h >> 12)) * 0x297a2d39U;
  return h ^ (h >> 15);
}
float cell_value(int x, int y, std::uint32_t seed) {
  return static_cast<float>(cell_hash(x, y, seed) >> 8) * 0x1.0p-24F;
}

/// Returns smooth noise, -1 to 1, with features of about one unit.
float noise(float x, float y, std::uint32_t seed) {
  const float fx = std::floor(x), fy = std::floor(y);
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
  float ax = x - fx, ay = y - fy;
  ax = ax * ax * (3.0F - 2.0F * ax);
  ay = ay * ay * (3.0F - 2.0F * ay);
  const float low = cell_value(ix, iy, seed) * (1 - ax) + cell_value(ix + 1, iy, seed) * ax;
  const float high = cell_value(ix, iy + 1, seed) * (1 - ax) + cell_value(ix + 1, iy + 1, seed) * ax;
  return 2.0F * (low * (1 - ay) + high * ay) - 1.0F;
}

/// Returns three octaves of noise, about -1 to 1.
float fractal(float x, float y, std::uint32_t seed) {
  return 0.57F * noise(x, y, seed) + 0.29F * noise(2.03F * x, 2.03F * y, seed + 1) +
         0.14F * noise(4.1F * x, 4.1F * y, seed + 2);
}

float step_between(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

Colour wood(const Colour& light, const Colour& dark, float along_m, float across_m, std::uint32_t seed) {
  const float offset = static_cast<float>(seed % 97U);
  const float bend = 0.5F * fractal(0.9F * along_m + offset, 2.5F * across_m, seed);
  const float ring = 0.5F + 0.5F * std::sin(kTurn * (11.0F * across_m + 1.6F * bend + offset));
  const float fibre = noise(9.0F * along_m + offset, 260.0F * across_m, seed + 5);
  const float pore = noise(35.0F * along_m, 520.0F * across_m + offset, seed + 6);
  const Colour base = mixed_colour(light, dark, 0.55F * ring * ring + 0.15F * std::abs(bend));
  return brighter(base, 1.0F + 0.09F * fibre - 0.22F * step_between(0.55F, 0.9F, pore));
}

Colour planks(const Material& m, float u_m, float v_m) {
  constexpr float kWide_m = 0.13F, kLong_m = 1.15F;
  const float row = std::floor(v_m / kWide_m);
  const float shift_m = kLong_m * cell_value(static_cast<int>(row), 7, m.seed);
  const float column = std::floor((u_m + shift_m) / kLong_m);
  const float in_v = v_m - row * kWide_m;
  const float in_u = u_m + shift_m - column * kLong_m;
  const std::uint32_t plank = cell_hash(static_cast<int>(column), static_cast<int>(row), m.seed);
  const float tint = 0.84F + 0.3F * static_cast<float>(plank % 1000U) / 1000.0F;
  const float edge_m = std::min(std::min(in_v, kWide_m - in_v), std::min(in_u, kLong_m - in_u));
  const float joint = 0.35F + 0.65F * step_between(0.0008F, 0.0035F, edge_m);
  return brighter(wood(colour_of(m.first), colour_of(m.second), in_u, in_v, plank), tint * joint);
}

Colour tiles(const Material& m, float u_m, float v_m, float width_m, float height_m) {
  const float size_m = std::min(0.33F, 0.25F * std::min(width_m, height_m));
  const float x = u_m / size_m, y = v_m / size_m;
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  const float in_x = x - std::floor(x) - 0.5F, in_y = y - std::floor(y) - 0.5F;
  const std::uint32_t tile = cell_hash(column, row, m.seed);
  Colour ground = brighter(colour_of(m.first), 0.9F + 0.16F * static_cast<float>(tile % 1000U) / 1000.0F);
  const float vein = fractal(3.0F * x + static_cast<float>(tile % 31U), 3.0F * y, m.seed + 3);
  ground = brighter(ground, 1.0F + 0.09F * vein + 0.05F * noise(60.0F * x, 60.0F * y, m.seed));
  const Colour ink = colour_of(m.second);
  if (tile % 4U == 0U) {  // a tile with an ornament
    const float diamond = std::abs(in_x) + std::abs(in_y);
    const float ring = std::hypot(in_x, in_y);
    if ((diamond > 0.3F && diamond < 0.36F) || ring < 0.1F + 0.05F * std::cos(4.0F * std::atan2(in_y, in_x)))
      ground = mixed_colour(ground, ink, 0.75F);
  }
  const float edge = 0.5F - std::max(std::abs(in_x), std::abs(in_y));
  return mixed_colour(ink, ground, step_between(0.006F, 0.018F, edge));
}

Colour carpet(const Material& m, float u_m, float v_m, float width_m, float height_m) {
  const Colour ground = colour_of(m.first), ink = colour_of(m.second);
  const Colour dark = brighter(ground, 0.5F);
  const float unit_m = std::min(0.1F, 0.12F * std::min(width_m, height_m));
  const float edge = (0.5F * std::min(width_m - 2 * std::abs(u_m), height_m - 2 * std::abs(v_m))) / unit_m;
  const float x = u_m / (3.0F * unit_m), y = v_m / (3.0F * unit_m);
  const float in_x = 2.0F * (x - std::floor(x)) - 1.0F, in_y = 2.0F * (y - std::floor(y)) - 1.0F;
  const std::uint32_t cell =
      cell_hash(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)), m.seed);
  const float ring = std::hypot(in_x, in_y), angle = std::atan2(in_y, in_x);
  const float petals =
      0.55F + 0.22F * std::cos(static_cast<float>(4U + cell % 5U) * angle + static_cast<float>(cell % 7U));
  Colour colour = ground;
  if (ring < 0.3F * petals) {
    colour = dark;
  } else if (ring < petals) {
    colour = cell % 3U == 0U ? mixed_colour(ink, ground, 0.5F) : ink;
  } else if (std::abs(in_x) + std::abs(in_y) > 1.75F) {
    colour = dark;
  }
  if (edge < 0.4F) {
    colour = dark;
  } else if (edge < 0.6F) {
    colour = ink;
  } else if (edge < 1.4F) {
    const float along = (std::abs(u_m) * height_m > std::abs(v_m) * width_m ? v_m : u_m) / unit_m;
    colour = std::sin(kTurn * 0.8F * along + kTurn * 0.5F * edge) > 0.2F ? ink : dark;
  } else if (edge < 1.55F) {
    colour = ink;
  }
  const float weave =
      noise(u_m * 420.0F, v_m * 420.0F, m.seed) + 0.6F * noise(u_m * 90.0F, v_m * 90.0F, m.seed + 1);
  return brighter(colour, 1.0F + 0.13F * weave);
}

Colour poster(const Material& m, float u_m, float v_m, float width_m, float height_m) {
  const Colour ground = colour_of(m.first), ink = colour_of(m.second);
  const float x = u_m / width_m, y = v_m / height_m;  // -0.5 to 0.5
  const float aspect = height_m / width_m;
  Colour colour = mixed_colour(ground, brighter(ground, 0.86F), 0.5F - y);
  for (std::uint64_t i = 0; i < 9; ++i) {
    CounterRandom random(m.seed, i);
    const float cx = static_cast<float>(random.uniform(-0.42, 0.42)),
                cy = static_cast<float>(random.uniform(-0.25, 0.42));
    const float size = static_cast<float>(random.uniform(0.05, 0.2)),
                shape = static_cast<float>(random.uniform());
    const Colour third = {ground[1] * 0.7F, ink[2] * 0.8F + 0.1F, ink[0] * 0.8F};
    const float part = static_cast<float>(random.uniform(0.0, 1.0));
    const Colour paint =
        part < 0.5F ? mixed_colour(ink, ground, part * 0.6F) : mixed_colour(third, ink, part - 0.5F);
    const float dx = x - cx, dy = (y - cy) * aspect;
    const bool inside = shape < 0.35F ? std::hypot(dx, dy) < size &&
                                            std::hypot(dx, dy) > (shape < 0.15F ? 0.55F * size : 0.0F)
                        : shape < 0.65F ? std::abs(dx) < size && std::abs(dy) < 0.45F * size
                        : shape < 0.85F ? dy > -size && dy < size && std::abs(dx) < 0.5F * (size - dy)
                                        : std::abs(dx + dy) < 0.18F * size && std::abs(dx - dy) < 2.2F * size;
    if (inside) colour = paint;
  }
  const float line = (-0.32F - y) / 0.045F;  // lines of text at the bottom
  if (line > 0.0F && line < 3.0F && std::abs(x) < 0.4F) {
    const int row = static_cast<int>(line);
    const int letter = static_cast<int>(std::floor((x + 0.5F) * 42.0F));
    const float in_line = line - static_cast<float>(row);
    const bool written = cell_hash(letter, row, m.seed) % 5U != 0U && in_line > 0.2F && in_line < 0.75F;
    const float stroke = cell_value(static_cast<int>(std::floor((x + 0.5F) * 126.0F)),
                                    row * 5 + static_cast<int>(in_line * 5), m.seed + 1);
    if (written && stroke > 0.35F) colour = ink;
  }
  if (std::abs(x) > 0.475F || std::abs(y) > 0.5F - 0.025F / aspect)
    colour = mixed_colour(ground, {1, 1, 1}, 0.5F);
  return brighter(colour, 1.0F + 0.03F * noise(u_m * 300.0F, v_m * 300.0F, m.seed));
}

Colour landscape(const Material& m, float u_m, float v_m, float width_m, float height_m) {
  const float x = u_m / height_m, y = v_m / height_m + 0.5F;  // y: 0 at the bottom, 1 at the top
  const Colour sky = colour_of(m.first), meadow = colour_of(m.second);
  const float offset = static_cast<float>(m.seed % 53U);
  Colour colour = mixed_colour(mixed_colour(sky, {1, 1, 1}, 0.55F), sky, step_between(0.4F, 1.0F, y));
  const float cloud = fractal(2.2F * x + offset, 4.5F * y, m.seed) + 0.15F;
  colour = mixed_colour(colour, {0.98F, 0.97F, 0.95F}, 0.85F * step_between(0.05F, 0.4F, cloud));
  const float sun = std::hypot(x - 0.28F * width_m / height_m, y - 0.82F);
  if (sun < 0.07F) colour = {1.0F, 0.93F, 0.68F};
  for (int hill = 0; hill < 4; ++hill) {
    const auto nearness = static_cast<float>(hill + 1) / 4.0F;
    const float crest = 0.5F - 0.12F * static_cast<float>(hill) +
                        0.1F * fractal((1.2F + static_cast<float>(hill)) * x + offset, 0.3F,
                                       m.seed + static_cast<std::uint32_t>(hill) * 9U);
    if (y > crest) continue;
    const float tree = noise(x * 40.0F * nearness + offset, y * 60.0F * nearness,
                             m.seed + 40U + static_cast<std::uint32_t>(hill));
    colour = brighter(mixed_colour(mixed_colour(sky, meadow, 0.35F), meadow, nearness),
                      1.0F - 0.3F * nearness + 0.28F * tree);
  }
  const float flower = cell_value(static_cast<int>(std::floor(x * 45.0F)),
                                  static_cast<int>(std::floor(y * 45.0F)), m.seed + 77U);
  if (y < 0.2F && flower > 0.93F)
    colour = flower > 0.965F ? Colour{0.95F, 0.85F, 0.3F} : Colour{0.9F, 0.4F, 0.35F};
  return colour;
}

Colour spine(const Material& m, float u_m, float v_m, float width_m, float height_m) {
  const bool upright = height_m > width_m;
  const float length_m = upright ? height_m : width_m, thick_m = upright ? width_m : height_m;
  const float along = (upright ? v_m : u_m) / length_m, across = (upright ? u_m : v_m) / thick_m;
  Colour colour = colour_of(m.first);
  const Colour ink = colour_of(m.second);
  const float band = 0.32F + 0.1F * cell_value(1, 2, m.seed);
  const float from_band = std::abs(std::abs(along) - band);
  if (from_band < 0.012F || (m.seed % 3U == 0U && from_band > 0.03F && from_band < 0.04F)) colour = ink;
  if (m.seed % 4U == 1U && std::abs(along) > band) colour = mixed_colour(colour, ink, 0.35F);
  if (std::abs(along) < 0.26F && std::abs(across) < 0.26F) {
    const int letter = static_cast<int>(std::floor(along * 34.0F));
    const int stroke =
        static_cast<int>(std::floor(along * 102.0F)) * 8 + static_cast<int>(std::floor(across * 6.0F));
    if (cell_hash(letter, 3, m.seed) % 6U != 0U && cell_value(stroke, 4, m.seed) > 0.4F) colour = ink;
  }
  return brighter(colour, 1.0F + 0.06F * noise(u_m * 250.0F, v_m * 250.0F, m.seed) +
                              0.05F * noise(u_m * 30.0F, v_m * 30.0F, m.seed + 1));
}

Colour fabric(const Material& m, float u_m, float v_m) {
  const float weave = std::sin(kTurn * u_m / 0.006F) * std::sin(kTurn * v_m / 0.006F);
  const float stripe = std::sin(kTurn * u_m / 0.055F);
  const float fold = fractal(u_m * 7.0F, v_m * 7.0F, m.seed);
  const Colour base =
      mixed_colour(colour_of(m.first), colour_of(m.second), stripe > 0.8F ? 0.7F : 0.15F + 0.12F * fold);
  return brighter(base,
                  1.0F + 0.05F * weave + 0.09F * noise(u_m * 120.0F, v_m * 120.0F, m.seed) + 0.06F * fold);
}

/// Draws a checkerboard centred in a white margin. Edges are blurred by a texel's width, so that their
/// position does not depend on the texel grid.
Colour checker(const Material& m, float u_m, float v_m, float width_m, float height_m) {
  constexpr float kSoft_m = 0.003F;
  const float columns = std::floor(width_m / kCheckerSquare_m - 1.0F);
  const float rows = std::floor(height_m / kCheckerSquare_m - 1.0F);
  // 1 at the centre of even squares, -1 at the centre of odd ones, 0 at the edges, white outside.
  const auto side = [](float at, float count) {
    const float nearest_edge = std::clamp(std::round(at), 0.0F, count);
    const float beyond = std::clamp((at - nearest_edge) * kCheckerSquare_m / kSoft_m, -1.0F, 1.0F);
    return static_cast<int>(nearest_edge) % 2 == 0 ? beyond : -beyond;
  };
  const float x = u_m / kCheckerSquare_m + 0.5F * columns;
  const float y = v_m / kCheckerSquare_m + 0.5F * rows;
  const float inside_m = kCheckerSquare_m * std::min({x, columns - x, y, rows - y});
  const float within = std::clamp(0.5F + 0.5F * inside_m / kSoft_m, 0.0F, 1.0F);
  const float dark = within * (0.5F + 0.5F * side(x, columns) * side(y, rows));
  return mixed_colour(colour_of(m.first), colour_of(m.second), dark);
}

}  // namespace

std::array<float, 3> pattern_colour(const Material& m, float u_m, float v_m, float width_m, float height_m) {
  const Colour first = colour_of(m.first), second = colour_of(m.second);
  switch (m.pattern) {
    case Pattern::kPortable:
      return brighter(mixed_colour(first, second, 0.15F + 0.15F * fractal(u_m * 9.0F, v_m * 9.0F, m.seed)),
                      1.0F + 0.035F * noise(u_m * 300.0F, v_m * 300.0F, m.seed));
    case Pattern::kPlaster: {
      const float blotch = 0.5F + 0.5F * fractal(u_m * 1.3F, v_m * 1.3F, m.seed);
      const float trowel = fractal(u_m * 9.0F, v_m * 16.0F, m.seed + 3);
      const float grain = noise(u_m * 110.0F, v_m * 110.0F, m.seed + 8);
      return brighter(mixed_colour(first, second, 0.7F * blotch), 1.0F + 0.04F * trowel + 0.04F * grain);
    }
    case Pattern::kWood:
      return height_m > width_m ? wood(first, second, v_m, u_m, m.seed)
                                : wood(first, second, u_m, v_m, m.seed);
    case Pattern::kPlanks:
      return planks(m, u_m, v_m);
    case Pattern::kTiles:
      return tiles(m, u_m, v_m, width_m, height_m);
    case Pattern::kCarpet:
      return carpet(m, u_m, v_m, width_m, height_m);
    case Pattern::kPoster:
      return poster(m, u_m, v_m, width_m, height_m);
    case Pattern::kLandscape:
      return landscape(m, u_m, v_m, width_m, height_m);
    case Pattern::kSpine:
      return spine(m, u_m, v_m, width_m, height_m);
    case Pattern::kFabric:
      return fabric(m, u_m, v_m);
    case Pattern::kStone: {
      const float grain =
          noise(u_m * 45.0F, v_m * 45.0F, m.seed) + 0.7F * noise(u_m * 160.0F, v_m * 160.0F, m.seed + 1);
      const float cloud = 0.5F + 0.5F * fractal(u_m * 1.7F, v_m * 1.7F, m.seed + 2);
      return brighter(mixed_colour(first, second, 0.4F * cloud + 0.45F * step_between(0.5F, 1.1F, grain)),
                      1.0F + 0.08F * grain);
    }
    case Pattern::kChecker:
      return checker(m, u_m, v_m, width_m, height_m);
    case Pattern::kSkin:
      return brighter(mixed_colour(first, second, 0.3F + 0.35F * fractal(u_m * 26.0F, v_m * 26.0F, m.seed)),
                      1.0F + 0.03F * noise(u_m * 400.0F, v_m * 400.0F, m.seed));
  }
  return first;
}

}  // namespace roomradar
