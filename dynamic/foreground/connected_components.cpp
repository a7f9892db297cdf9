// connected_components.cpp: connected components by runs and union-find.
#include "dynamic/foreground/connected_components.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/disjoint_sets.hpp"

namespace roomradar {
namespace {

// Returns the first pixel from x on, below `width`, that has one of the bits; `width` if there is none.
inline int next_marked(const std::uint8_t* evidence, int x, int width, std::uint8_t bits) {
  const std::uint64_t eight = 0x0101010101010101ULL * bits;
  for (; x + 8 <= width; x += 8) {
    std::uint64_t bytes;
    std::memcpy(&bytes, evidence + x, sizeof bytes);
    if ((bytes & eight) != 0) break;
  }
  while (x < width && (evidence[x] & bits) == 0) ++x;
  return x;
}

std::uint32_t root_of(std::vector<PixelRun>& runs, std::uint32_t run) {
  return find_root(run, [&](std::uint32_t of) -> std::uint32_t& { return runs[of].region; });
}

void join(std::vector<PixelRun>& runs, std::uint32_t a, std::uint32_t b) {
  a = root_of(runs, a);
  b = root_of(runs, b);
  runs[std::max(a, b)].region = std::min(a, b);
}

// Adds the sums of all runs to those of their region's root, and stores the root in each run.
void sum_regions(ConnectedComponents& found) {
  for (std::uint32_t i = 0; i < found.runs.size(); ++i) {
    const std::uint32_t root = found.runs[i].region = root_of(found.runs, i);
    if (root == i) continue;
    ConnectedComponent& all = found.regions[root];
    const ConnectedComponent& part = found.regions[i];
    all.pixels += part.pixels;
    all.strong += part.strong;
    all.ambiguous += part.ambiguous;
    all.before += part.before;
    all.core += part.core;
    all.depth2_m2 += part.depth2_m2;
  }
}

}  // namespace

void find_components(const DepthImage& depth_m, const std::vector<std::uint8_t>& evidence,
                     const RegionBits& bits, const Intrinsics& camera, const ConnectionRules& rules,
                     ConnectedComponents& found) {
  const DepthNoise noise = rules.noise;
  const int max_gap_px = rules.max_gap_px;
  found.runs.reserve(depth_m.pixels.size());
  found.first_run.reserve(static_cast<std::size_t>(depth_m.height));
  found.regions.reserve(depth_m.pixels.size());
  found.runs.clear();
  found.regions.clear();
  const float slope = 5.67F / static_cast<float>(std::min(camera.fx_px, camera.fy_px));
  const float* depth = depth_m.pixels.data();
  const auto any = static_cast<std::uint8_t>(bits.weak | bits.strong);
  const auto hang_together = [&](std::uint32_t a, std::uint32_t b) {
    if ((evidence[a] & evidence[b] & bits.strong) != 0) return true;
    const float z = std::min(depth[a], depth[b]);
    return std::abs(depth[a] - depth[b]) <= 4.0F * depth_sigma_m(noise, z) + slope * z;
  };

  const auto is_gap = [&](std::uint32_t first, std::uint32_t end) {
    return first < end && static_cast<int>(end - first) <= max_gap_px &&
           std::all_of(depth + first, depth + end, [](float z) { return !(z > 0.0F); });
  };
  // Two pixels of a row or column, `apart` pixels from each other, with only unmeasured pixels between them.
  const auto is_one_surface = [&](std::uint32_t a, std::uint32_t b, int apart) {
    const float z = std::min(depth[a], depth[b]);
    return std::abs(depth[a] - depth[b]) <=
           4.0F * depth_sigma_m(noise, z) + slope * static_cast<float>(apart) * z;
  };

  std::vector<PixelRun>& runs = found.runs;
  found.first_run.clear();
  const auto run_of = [&](std::uint32_t pixel, std::uint32_t pixel_row) {
    const auto begin = runs.begin() + found.first_run[pixel_row];
    const auto end = runs.begin() + found.first_run[pixel_row + 1];
    const auto after = std::upper_bound(
        begin, end, pixel, [](std::uint32_t value, const PixelRun& run) { return value < run.first; });
    return static_cast<std::uint32_t>(after - runs.begin()) - 1;
  };
  std::size_t above = 0;  // first run of the row above that may touch
  std::size_t row_begin = 0;
  const auto width = static_cast<std::uint32_t>(depth_m.width);
  for (int y = 0; y < depth_m.height; ++y) {
    const std::uint32_t row = static_cast<std::uint32_t>(y) * width;
    const std::uint8_t* marks = evidence.data() + row;
    above = row_begin;
    row_begin = runs.size();
    const std::size_t above_end = row_begin;
    found.first_run.push_back(static_cast<std::uint32_t>(row_begin));
    for (int x = next_marked(marks, 0, depth_m.width, any); x < depth_m.width;
         x = next_marked(marks, x, depth_m.width, any)) {
      const auto id = static_cast<std::uint32_t>(runs.size());
      PixelRun run{row + static_cast<std::uint32_t>(x), 0, id};
      ConnectedComponent sums;
      std::uint32_t pixel = run.first;
      do {
        ++sums.pixels;
        sums.strong += (evidence[pixel] & bits.strong) != 0;
        sums.ambiguous += (evidence[pixel] & (bits.ambiguous | bits.strong)) == bits.ambiguous;
        sums.before += (evidence[pixel] & bits.before) != 0;
        sums.core += (evidence[pixel] & bits.core) != 0;
        sums.depth2_m2 += depth[pixel] * depth[pixel];
        ++pixel;
        ++x;
      } while (x < depth_m.width && (marks[x] & any) != 0 && hang_together(pixel - 1, pixel));
      run.last = pixel - 1;
      runs.push_back(run);
      found.regions.push_back(sums);
      while (above < above_end && runs[above].last + width < run.first) ++above;
      for (std::size_t other = above; other < above_end && runs[other].first + width <= run.last; ++other) {
        const std::uint32_t first = std::max(run.first, runs[other].first + width);
        const std::uint32_t last = std::min(run.last, runs[other].last + width);
        for (std::uint32_t p = first; p <= last; ++p) {
          if (!hang_together(p, p - width)) continue;
          join(runs, id, static_cast<std::uint32_t>(other));
          break;
        }
      }
      if (max_gap_px == 0) continue;
      if (id > row_begin && is_gap(runs[id - 1].last + 1, run.first) &&
          is_one_surface(runs[id - 1].last, run.first, static_cast<int>(run.first - runs[id - 1].last)))
        join(runs, id, id - 1);
      for (std::uint32_t p = run.first; p <= run.last && y > 1; ++p) {
        if (depth[p - width] > 0.0F) continue;
        for (int up = 2; up <= std::min(max_gap_px + 1, y); ++up) {
          const std::uint32_t q = p - static_cast<std::uint32_t>(up) * width;
          if (!(depth[q] > 0.0F)) continue;
          if ((evidence[q] & any) != 0 && is_one_surface(p, q, up))
            join(runs, id, run_of(q, static_cast<std::uint32_t>(y - up)));
          break;
        }
      }
    }
  }
  sum_regions(found);
}

}  // namespace roomradar
