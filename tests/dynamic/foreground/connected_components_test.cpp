// connected_components_test.cpp: runs and union-find against a flood fill; dilation against a direct window.
#include "dynamic/foreground/connected_components.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "dynamic/foreground/pixel_blocks.hpp"
#include "mapping/types/depth_noise.hpp"

namespace roomradar::connected_components_test {
namespace {

constexpr RegionBits kBits{1, 2, 4, 8, 16};

bool hang_together(const DepthImage& depth_m, const std::vector<std::uint8_t>& evidence, std::size_t a,
                   std::size_t b, double focal_px) {
  if ((evidence[a] & 2) != 0 && (evidence[b] & 2) != 0) return true;
  const float z = std::min(depth_m.pixels[a], depth_m.pixels[b]);
  const auto slope = static_cast<float>(5.67 / focal_px);
  return std::abs(depth_m.pixels[a] - depth_m.pixels[b]) <= 4.0F * depth_sigma_m(DepthNoise{}, z) + slope * z;
}

// Component number of each pixel, 0 for none.
std::vector<int> flood(const DepthImage& depth_m, const std::vector<std::uint8_t>& evidence,
                       double focal_px) {
  std::vector<int> number(evidence.size(), 0);
  int regions = 0;
  for (std::size_t seed = 0; seed < evidence.size(); ++seed) {
    if ((evidence[seed] & 3) == 0 || number[seed] != 0) continue;
    number[seed] = ++regions;
    std::vector<std::size_t> open{seed};
    while (!open.empty()) {
      const std::size_t pixel = open.back();
      open.pop_back();
      const int x = static_cast<int>(pixel) % depth_m.width, y = static_cast<int>(pixel) / depth_m.width;
      for (const auto& [u, v] : {std::pair{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}) {
        if (!depth_m.contains(u, v)) continue;
        const std::size_t other = depth_m.index(u, v);
        if ((evidence[other] & 3) == 0 || number[other] != 0) continue;
        if (!hang_together(depth_m, evidence, pixel, other, focal_px)) continue;
        number[other] = regions;
        open.push_back(other);
      }
    }
  }
  return number;
}

TEST(ConnectedComponents, AreThoseOfAFloodFill) {
  std::mt19937 random(1);
  for (int round = 0; round < 40; ++round) {
    const int width = 1 + static_cast<int>(random() % 70), height = 1 + static_cast<int>(random() % 40);
    const Intrinsics camera{width, height, 100.0, 100.0, 0.0, 0.0};
    DepthImage depth_m(width, height);
    std::vector<std::uint8_t> evidence(depth_m.pixels.size());
    const auto holes = 1 + random() % 5;
    for (std::size_t i = 0; i < evidence.size(); ++i) {
      depth_m.pixels[i] = 1.0F + 0.05F * static_cast<float>(random() % 4);
      evidence[i] = static_cast<std::uint8_t>(random() % holes == 0 && holes > 1 ? 0 : random() % 32);
    }
    ConnectedComponents found;
    find_components(depth_m, evidence, kBits, camera, {}, found);
    const std::vector<int> truth = flood(depth_m, evidence, 100.0);

    std::vector<int> number(evidence.size(), 0);
    std::map<std::uint32_t, int> name;
    for (const PixelRun& run : found.runs) {
      for (std::uint32_t i = run.first; i <= run.last; ++i) {
        EXPECT_EQ(number[i], 0) << "in two runs";
        number[i] = static_cast<int>(run.region) + 1;
      }
    }
    std::map<int, int> of_truth, of_found;
    std::map<int, ConnectedComponent> sums;
    for (std::size_t i = 0; i < evidence.size(); ++i) {
      ASSERT_EQ(number[i] == 0, truth[i] == 0) << i;
      if (truth[i] == 0) continue;
      EXPECT_EQ(of_truth.try_emplace(truth[i], number[i]).first->second, number[i]);
      EXPECT_EQ(of_found.try_emplace(number[i], truth[i]).first->second, truth[i]);
      ConnectedComponent& sum = sums[number[i]];
      ++sum.pixels;
      sum.strong += (evidence[i] & 2) != 0;
      sum.ambiguous += (evidence[i] & 6) == 4;
      sum.before += (evidence[i] & 8) != 0;
      sum.core += (evidence[i] & 16) != 0;
      sum.depth2_m2 += depth_m.pixels[i] * depth_m.pixels[i];
    }
    for (const auto& [id, sum] : sums) {
      const ConnectedComponent& region = found.regions[static_cast<std::size_t>(id - 1)];
      EXPECT_EQ(region.pixels, sum.pixels);
      EXPECT_EQ(region.strong, sum.strong);
      EXPECT_EQ(region.ambiguous, sum.ambiguous);
      EXPECT_EQ(region.before, sum.before);
      EXPECT_EQ(region.core, sum.core);
      EXPECT_NEAR(region.depth2_m2, sum.depth2_m2, 1e-4F * sum.depth2_m2);
    }
  }
}

std::size_t components_across(const DepthImage& depth_m, int max_gap_px) {
  std::vector<std::uint8_t> evidence(depth_m.pixels.size());
  for (std::size_t i = 0; i < evidence.size(); ++i) evidence[i] = depth_m.pixels[i] < 1.5F ? 3 : 0;
  for (std::size_t i = 0; i < evidence.size(); ++i)
    if (!(depth_m.pixels[i] > 0.0F)) evidence[i] = 0;
  ConnectedComponents found;
  const Intrinsics camera{depth_m.width, depth_m.height, 585.0, 585.0, 0.0, 0.0};
  find_components(depth_m, evidence, kBits, camera, {.max_gap_px = max_gap_px}, found);
  std::size_t roots = 0;
  for (std::size_t run = 0; run < found.runs.size(); ++run) roots += found.runs[run].region == run;
  return roots;
}

TEST(ConnectedComponents, BridgeUnmeasuredPixelsOfOneSurfaceAndNothingElse) {
  // Two pixels in a row, or in a column, with a gap of three between them.
  for (const bool in_a_row : {true, false}) {
    const auto gap = [&](float between_m, float far_side_m) {
      DepthImage depth_m(9, 9, 2.0F);
      for (int i = 2; i <= 6; ++i)
        (in_a_row ? depth_m.at(i, 4) : depth_m.at(4, i)) = i == 2 ? 1.0F : i == 6 ? far_side_m : between_m;
      return depth_m;
    };
    EXPECT_EQ(components_across(gap(0.0F, 1.0F), 3), 1U);
    EXPECT_EQ(components_across(gap(0.0F, 1.0F), 2), 2U) << "wider than is bridged";
    EXPECT_EQ(components_across(gap(0.0F, 1.0F), 0), 2U);
    EXPECT_EQ(components_across(gap(2.0F, 1.0F), 3), 2U) << "something else was measured between them";
    EXPECT_EQ(components_across(gap(0.0F, 1.3F), 3), 2U) << "another surface";
  }
}

TEST(PixelBlocks, SpreadingInStepsIsTheBestOfTheWindow) {
  std::mt19937 random(2);
  const auto larger = [](int a, int b) { return a > b ? a : b; };
  for (const auto& [columns, rows] : {std::pair{1, 1}, {2, 7}, {13, 9}, {40, 30}}) {
    const BlockGrid grid{columns, rows};
    std::vector<int> values(grid.size()), spread_values, along_rows;
    for (int& value : values) value = static_cast<int>(random() % 1000);
    spread_values = values;
    int reach = 0;
    for (const int step : {1, 2, 3}) {
      spread(grid, spread_values, step, larger, along_rows, spread_values);
      reach += step;
      for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
          int best = 0;
          for (int v = std::max(y - reach, 0); v <= std::min(y + reach, rows - 1); ++v)
            for (int u = std::max(x - reach, 0); u <= std::min(x + reach, columns - 1); ++u)
              best = std::max(best, values[grid.at(u, v)]);
          EXPECT_EQ(spread_values[grid.at(x, y)], best) << x << " " << y << " reach " << reach;
        }
      }
    }
  }
}

}  // namespace
}  // namespace roomradar::connected_components_test
