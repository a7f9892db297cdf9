// stationary_camera.cpp: detects that the camera did not move between two images.
#include "mapping/alignment/stationary_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomradar {
namespace {

/// Affine change of brightness: now = gain * before + offset.
struct Brightness {
  double gain = 1.0, offset = 0.0;
};

/// Fits the change of brightness by least squares, twice: the second time only to pixels that the first fit
/// explains, which leaves out most of what moved.
Brightness brightness_change(const Image<float>& before, const Image<float>& now) {
  constexpr double kExplained = 12.0;  // grey levels
  constexpr std::size_t kStep = 3;     // a third of the pixels is enough
  Brightness change;
  for (int round = 0; round < 2; ++round) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (std::size_t i = 0; i < before.pixels.size(); i += kStep) {
      const double a = static_cast<double>(before.pixels[i]), b = static_cast<double>(now.pixels[i]);
      if (round > 0 && std::abs(change.gain * a + change.offset - b) > kExplained) continue;
      n += 1.0, x += a, y += b, xx += a * a, xy += a * b;
    }
    const double determinant = n * xx - x * x;
    if (!(determinant > 1.0)) return change;
    change.gain = std::clamp((n * xy - x * y) / determinant, 0.5, 2.0);
    change.offset = (y - change.gain * x) / n;
  }
  return change;
}

/// Counts of edge pixels: in total, by the direction of their gradient, and per cell of a grid.
struct EdgeCounts {
  static constexpr int kColumns = 8, kRows = 6;
  int edges = 0, unmoved = 0;
  std::array<int, 2> edges_along{}, unmoved_along{};  ///< gradient mainly along x, along y
  std::array<int, kColumns * kRows> cell_edges{}, cell_unmoved{};

  [[nodiscard]] double unmoved_part() const { return edges > 0 ? static_cast<double>(unmoved) / edges : 0.0; }
  /// Returns the smaller of the fractions of edges along x and along y that did not move: a motion along
  /// edges does not move them. 0 if there are few edges in one of the directions.
  [[nodiscard]] double unmoved_part_of_both() const {
    constexpr int kFewest = 100;
    double least = 1.0;
    for (std::size_t i = 0; i < edges_along.size(); ++i)
      least = std::min(least, edges_along[i] < kFewest ? 0.0
                                                       : static_cast<double>(unmoved_along[i]) /
                                                             static_cast<double>(edges_along[i]));
    return least;
  }
  /// Fraction of the cells with edges in which most edges did not move.
  [[nodiscard]] double unmoved_cells() const {
    constexpr int kFewest = 10;
    int cells = 0, still = 0;
    for (std::size_t i = 0; i < cell_edges.size(); ++i) {
      if (cell_edges[i] < kFewest) continue;
      ++cells;
      still += 2 * cell_unmoved[i] > cell_edges[i] ? 1 : 0;
    }
    return cells > 0 ? static_cast<double>(still) / cells : 0.0;
  }
};

EdgeCounts count_edges(const Image<float>& before, const Image<float>& now, const Brightness& change) {
  constexpr float kEdge = 10.0F;     // grey levels per pixel, well above a camera's noise
  constexpr float kShift_px = 0.2F;  // an edge that moved this far changes a pixel by a fifth of its gradient
  const auto gain = static_cast<float>(change.gain), offset = static_cast<float>(change.offset);
  EdgeCounts counts;
  for (int y = 1; y + 1 < before.height; ++y) {
    const float* above = before.row(y - 1);
    const float* row = before.row(y);
    const float* below = before.row(y + 1);
    const float* row_now = now.row(y);
    const int cell_row = y * EdgeCounts::kRows / before.height * EdgeCounts::kColumns;
    for (int x = 1; x + 1 < before.width; ++x) {
      const float gu = 0.5F * (row[x + 1] - row[x - 1]), gv = 0.5F * (below[x] - above[x]);
      const float squared = gu * gu + gv * gv;
      if (squared < kEdge * kEdge) continue;
      const float difference = row_now[x] - (gain * row[x] + offset);
      const int is_unmoved = difference * difference < kShift_px * kShift_px * squared ? 1 : 0;
      const auto cell = static_cast<std::size_t>(cell_row + x * EdgeCounts::kColumns / before.width);
      const std::size_t along = std::abs(gu) > std::abs(gv) ? 0 : 1;
      ++counts.edges;
      ++counts.edges_along[along];
      counts.unmoved_along[along] += is_unmoved;
      ++counts.cell_edges[cell];
      counts.unmoved += is_unmoved;
      counts.cell_unmoved[cell] += is_unmoved;
    }
  }
  return counts;
}

}  // namespace

bool is_camera_stationary(const Image<float>& before, const Image<float>& now, int stood_frames) {
  constexpr int kFewest = 300, kLong_frames = 5;
  constexpr double kMostPart = 0.6;
  constexpr double kSpreadPart = 0.4, kStillPart = 0.18;  // of the edges, if they are spread over the image
  constexpr double kSpreadCells = 0.3, kStillCells = 0.2;
  if (before.width != now.width || before.height != now.height) return false;
  EdgeCounts counts = count_edges(before, now, {});
  if (counts.edges < kFewest) return false;
  if (counts.unmoved_part() > kMostPart) return true;
  if (stood_frames < 1) return false;
  const bool stood_long = stood_frames >= kLong_frames;
  counts = count_edges(before, now, brightness_change(before, now));
  return counts.unmoved_part_of_both() > (stood_long ? kStillPart : kSpreadPart) &&
         counts.unmoved_cells() > (stood_long ? kStillCells : kSpreadCells);
}

}  // namespace roomradar
