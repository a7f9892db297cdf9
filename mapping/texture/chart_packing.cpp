// chart_packing.cpp: rows of charts, from the highest to the lowest.
#include "mapping/texture/chart_packing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "mapping/texture/chart_texels.hpp"

namespace roomradar {
namespace {

constexpr int kJpegBlock_px = 16;  // of a JPEG with reduced colour resolution
constexpr int kMaxRounds = 60;     // only the padding is left then

int in_blocks(double size_px) { return static_cast<int>(std::ceil(size_px / kJpegBlock_px)) * kJpegBlock_px; }

/// Turns charts to be wider than high, for fuller rows.
void lay_down(TextureChart& chart) {
  if (chart.size_m.x() >= chart.size_m.y()) return;
  // A quarter turn: x becomes y, and y becomes -x.
  const Eigen::RowVector3f x = chart.axes.row(0);
  chart.axes.row(0) = chart.axes.row(1);
  chart.axes.row(1) = -x;
  chart.low_m = {chart.low_m.y(), -chart.low_m.x() - chart.size_m.x()};
  std::swap(chart.size_m.x(), chart.size_m.y());
}

/// Places the charts in rows of width_px; returns the height of all rows.
std::int64_t place(std::vector<TextureChart>& charts, const std::vector<std::size_t>& order, int width_px) {
  std::int64_t top = 0;
  int left = 0, row_height = 0;
  for (const std::size_t i : order) {
    TextureChart& chart = charts[i];
    if (left + chart.size_px.x() > width_px) {
      top += row_height;
      left = row_height = 0;
    }
    chart.corner_px = {left, static_cast<int>(std::min<std::int64_t>(top, 1 << 30))};
    left += chart.size_px.x();
    row_height = std::max(row_height, chart.size_px.y());
  }
  return top + row_height;
}

}  // namespace

Eigen::Vector2i pack(std::vector<TextureChart>& charts, int max_side_px) {
  for (TextureChart& chart : charts) lay_down(chart);
  std::vector<std::size_t> order(charts.size());
  for (int round = 0; round < kMaxRounds; ++round) {
    double area_px = 0.0;
    int widest_px = 1;
    for (TextureChart& chart : charts) {
      set_size_px(chart);
      area_px += static_cast<double>(chart.size_px.x()) * chart.size_px.y();
      widest_px = std::max(widest_px, chart.size_px.x());
    }
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return charts[a].size_px.y() > charts[b].size_px.y();
    });
    const int width_px =
        std::min(max_side_px, std::max(in_blocks(widest_px), in_blocks(std::sqrt(1.05 * area_px))));
    const std::int64_t height_px = place(charts, order, width_px);
    const double excess =
        std::max(static_cast<double>(height_px), static_cast<double>(widest_px)) / max_side_px;
    if (excess <= 1.0) return {width_px, in_blocks(static_cast<double>(height_px))};
    const auto larger = static_cast<float>(std::max(1.02, std::sqrt(std::min(excess, 16.0))));
    for (TextureChart& chart : charts) chart.texel_m *= larger;
  }
  return Eigen::Vector2i::Zero();
}

}  // namespace roomradar
