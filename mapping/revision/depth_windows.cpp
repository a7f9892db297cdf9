// depth_windows.cpp: table of minima over squares, each level computed from the one below.
#include "mapping/revision/depth_windows.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <limits>

namespace roomradar {
namespace {

constexpr int kLevels = std::bit_width(static_cast<unsigned>(2 * kMaxWindowRadius_px + 1));

// Computes minima over squares of twice the side; ignores parts beyond the image's border.
void double_side(const DepthImage& fine, int side, DepthImage& coarse) {
  coarse.width = fine.width;
  coarse.height = fine.height;
  coarse.pixels.resize(fine.pixels.size());
  for (int y = 0; y < fine.height; ++y) {
    const float* upper = fine.row(y);
    const float* lower = fine.row(std::min(y + side, fine.height - 1));
    float* out = coarse.row(y);
    const int inner = std::max(fine.width - side, 0);
    for (int x = 0; x < inner; ++x)
      out[x] = std::min(std::min(upper[x], upper[x + side]), std::min(lower[x], lower[x + side]));
    for (int x = inner; x < fine.width; ++x) out[x] = std::min(upper[x], lower[x]);
  }
}

void count_measured(const DepthImage& depth_m, Image<std::int32_t>& measured) {
  measured.resize(depth_m.width + 1, depth_m.height + 1);
  for (int y = 0; y < depth_m.height; ++y) {
    std::int32_t in_row = 0;
    for (int x = 0; x < depth_m.width; ++x) {
      in_row += depth_m.at(x, y) > 0.0F ? 1 : 0;
      measured.at(x + 1, y + 1) = measured.at(x + 1, y) + in_row;
    }
  }
}

}  // namespace

void build_windows(const DepthImage& depth_m, DepthWindows& windows) {
  windows.nearest_m.resize(kLevels);
  windows.nearest_m[0] = depth_m;
  for (float& nearest_m : windows.nearest_m[0].pixels)
    nearest_m = nearest_m > 0.0F ? nearest_m : std::numeric_limits<float>::infinity();
  for (int k = 1; k < kLevels; ++k)
    double_side(windows.nearest_m[static_cast<std::size_t>(k - 1)], 1 << (k - 1),
                windows.nearest_m[static_cast<std::size_t>(k)]);
  count_measured(depth_m, windows.measured);
}

WindowDepth window_depth(const DepthWindows& windows, int x, int y, int radius_px) {
  assert(windows.nearest_m.front().contains(x, y) && radius_px >= 0 && radius_px <= kMaxWindowRadius_px);
  const int side = 2 * radius_px + 1;
  const int level = std::bit_width(static_cast<unsigned>(side)) - 1;
  const DepthImage& nearest_m = windows.nearest_m[static_cast<std::size_t>(level)];
  const int left = std::max(x - radius_px, 0);
  const int top = std::max(y - radius_px, 0);
  const int end_x = std::min(x + radius_px + 1, nearest_m.width);
  const int end_y = std::min(y + radius_px + 1, nearest_m.height);
  const int second_x = std::max(end_x - (1 << level), 0);
  const int second_y = std::max(end_y - (1 << level), 0);
  const auto& measured = windows.measured;
  const std::int32_t count =
      measured.at(end_x, end_y) - measured.at(left, end_y) - measured.at(end_x, top) + measured.at(left, top);
  return {std::min(std::min(nearest_m.at(left, top), nearest_m.at(second_x, top)),
                   std::min(nearest_m.at(left, second_y), nearest_m.at(second_x, second_y))),
          static_cast<float>(count) / static_cast<float>(side * side)};
}

}  // namespace roomradar
