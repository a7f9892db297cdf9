// cell_outline.cpp: tables of the pixels that each straight cut through a cell covers.
#include "dynamic/surface/cell_outline.hpp"

#include <bit>
#include <cmath>

namespace roomradar {
namespace {

// Max distance of a set pixel outside its polygon, and of an empty pixel inside it.
constexpr double kTolerance_px = 1.0 + 1e-6;

/// Returns twice the area of a triangle, positive if counter-clockwise as seen by the camera.
int turn(CellPixel a, CellPixel b, CellPixel c) {
  return (b.y - a.y) * (c.x - a.x) - (b.x - a.x) * (c.y - a.y);
}

struct Cut {
  CellBits allowed = 0;   // inside or slightly outside: pixels may be set
  CellBits required = 0;  // well inside: pixels must be set
};

Cut make_cut(int first, int last) {
  const CellPixel a = kRing[static_cast<std::size_t>(first)], b = kRing[static_cast<std::size_t>(last)];
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  Cut cut;
  for (std::int8_t y = 0; y < 5; ++y) {
    for (std::int8_t x = 0; x < 5; ++x) {
      const CellBits bit = CellBits{1} << (5 * y + x);
      // The run goes from a to b, so the polygon is on the left of the line from b to a.
      const double inside_px = first == last ? -std::hypot(x - a.x, y - a.y) : turn(b, a, {x, y}) / length;
      if (inside_px >= -kTolerance_px) cut.allowed |= bit;
      if (inside_px > kTolerance_px) cut.required |= bit;
    }
  }
  return cut;
}

struct CutTable {
  std::array<Cut, 256> cuts;
  CutTable() {
    for (int first = 0; first < 16; ++first)
      for (int last = 0; last < 16; ++last)
        cuts[static_cast<std::size_t>(16 * first + last)] = make_cut(first, last);
  }
};

std::uint32_t ring_of(CellBits pixels) {
  std::uint32_t ring = 0;
  for (std::size_t i = 0; i < kRing.size(); ++i) ring |= (pixels >> (5 * kRing[i].y + kRing[i].x) & 1U) << i;
  return ring;
}

}  // namespace

bool find_outline(CellBits pixels, RingArc& arc) {
  static const CutTable table;
  const std::uint32_t ring = ring_of(pixels);
  if (ring == 0xFFFFU) {
    arc = {0, 16};
    return true;
  }
  const std::uint32_t before = (ring << 1 | ring >> 15) & 0xFFFFU;
  const std::uint32_t starts = ring & ~before;
  if (std::popcount(starts) != 1) return false;
  const int first = std::countr_zero(starts);
  arc = {first, std::popcount(ring)};
  const Cut& cut = table.cuts[static_cast<std::size_t>(16 * first + (first + arc.count - 1) % 16)];
  return (pixels & ~cut.allowed) == 0 && (cut.required & ~pixels) == 0;
}

CellTriangles triangulate(const int* corners, int count) {
  CellTriangles result;
  std::array<std::uint8_t, 16> left;  // corners not cut off yet
  for (int i = 0; i < count; ++i) left[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(i);
  const auto pixel = [&](int i) {
    return kRing[static_cast<std::size_t>(corners[left[static_cast<std::size_t>(i % count)]])];
  };
  int area = 0;
  for (int i = 1; i + 1 < count; ++i) area += turn(pixel(0), pixel(i), pixel(i + 1));
  // The polygon is convex: any corner with a positive area may be cut off, as long as the rest has an area.
  while (count > 2 && area > 0) {
    int best = -1, best_area = 0, shortest = 1000;
    for (int i = 0; i < count; ++i) {
      const CellPixel before = pixel(i + count - 1), here = pixel(i), after = pixel(i + 1);
      const int ear = turn(before, here, after);
      const int dx = after.x - before.x, dy = after.y - before.y;
      if (ear <= 0 || (ear == area && count > 3) || dx * dx + dy * dy >= shortest) continue;
      best = i, best_area = ear, shortest = dx * dx + dy * dy;
    }
    if (best < 0) break;
    const auto at = [&](int i) { return left[static_cast<std::size_t>(i % count)]; };
    result.triangles[static_cast<std::size_t>(result.count++)] = {at(best + count - 1), at(best),
                                                                  at(best + 1)};
    for (int i = best; i + 1 < count; ++i)
      left[static_cast<std::size_t>(i)] = left[static_cast<std::size_t>(i + 1)];
    --count;
    area -= best_area;
  }
  return result;
}

}  // namespace roomradar
