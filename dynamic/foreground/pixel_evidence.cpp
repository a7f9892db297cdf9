// pixel_evidence.cpp: compares pixels row by row, then dilates the evidence over blocks.
#include "dynamic/foreground/pixel_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamic/foreground/foreground_history.hpp"

namespace roomradar {
namespace {

struct Union {
  std::uint8_t operator()(std::uint8_t a, std::uint8_t b) const { return static_cast<std::uint8_t>(a | b); }
};
struct Fewer {
  std::uint8_t operator()(std::uint8_t a, std::uint8_t b) const { return b < a ? b : a; }
};

// Expands the bounds of a row of blocks to one value per pixel.
void stretch_bounds(const ForegroundConfig& config, const ExpectedBounds& bounds,
                    const std::vector<std::uint8_t>& before, int row, int width, PixelEvidence& evidence) {
  const std::size_t begin = bounds.grid.at(0, row);
  stretch(bounds.sigma_m.data() + begin, width, evidence.row.strong_m.data());
  stretch(bounds.nearest_in_reach_m.data() + begin, width, evidence.row.nearest_m.data());
  stretch(bounds.farthest_in_reach_m.data() + begin, width, evidence.row.farthest_m.data());
  stretch(bounds.nearest_around_hole_m.data() + begin, width, evidence.row.around_hole_m.data());
  for (int x = 0; x < width; ++x) {
    const float sigma = evidence.row.strong_m[x];
    const bool was = before[begin + x / kBlock_px] != 0;
    const float factor = was ? config.hysteresis : 1.0F;
    evidence.row.weak_m[x] = factor * config.weak_sigmas * sigma;
    evidence.row.strong_m[x] = factor * config.strong_sigmas * sigma;
  }
}

// Expands what is known about the holes and islands of a row of blocks, if it has any.
void stretch_unmapped(const UnmappedSpace& unmapped, const ExpectedBounds& bounds, int row, int width,
                      RowBounds& pixels) {
  const std::size_t begin = bounds.grid.at(0, row),
                    end = begin + static_cast<std::size_t>(bounds.grid.columns);
  bool is_all_mapped = true;
  for (std::size_t i = begin; i < end; ++i)
    is_all_mapped &= (bounds.model_m[i] > 0.0F) & (bounds.is_island[i] == 0);
  if (is_all_mapped && pixels.is_all_mapped) return;  // the row before has set the same
  pixels.is_all_mapped = is_all_mapped;
  stretch(bounds.background_m.data() + begin, width, pixels.background_m.data());
  stretch(bounds.is_island.data() + begin, width, pixels.is_island.data());
  for (int x = 0; x < width; x += kBlock_px) {
    const std::size_t block = bounds.grid.at(x / kBlock_px, row);
    const BlockSurface& seen = unmapped.nearest[block];
    const bool has_come = !(bounds.model_m[block] > 0.0F) && seen.has_come != 0 && seen.unseen == 0;
    const int x_end = std::min(x + kBlock_px, width);
    std::fill(pixels.come_m.begin() + x, pixels.come_m.begin() + x_end, has_come ? seen.depth_m : 0.0F);
    std::fill(pixels.moving_m.begin() + x, pixels.moving_m.begin() + x_end,
              has_come && is_moving(seen) ? seen.depth_m : 0.0F);
  }
}

// Measured and expected depth of a row of pixels.
struct DepthRow {
  const float* live_m;
  const float* expected_m;
  int width;
};

// Computes the evidence of one row of pixels, without their neighbours.
void weigh_row(const DepthRow& row, const ForegroundConfig& config, const RowBounds& bounds,
               float misfit_per_m, std::uint8_t* bits, PixelLabel* labels) {
  const float* live = row.live_m;
  const float* expected = row.expected_m;
  const int width = row.width;
  const float* weak = bounds.weak_m.data();
  const float* strong = bounds.strong_m.data();
  const float* nearest = bounds.nearest_m.data();
  const float* farthest = bounds.farthest_m.data();
  for (int x = 0; x < width; ++x) {
    const float z = live[x];
    const float nearer = expected[x] - z;
    const int strongly_nearer = nearer > strong[x];
    const int strongly_farther = -nearer > strong[x];
    const int moved = (nearer > weak[x] ? kWeakMoved : 0) |
                      (strongly_nearer ? (z < nearest[x] - strong[x] ? kStrongMoved : kAmbiguousMoved) : 0);
    const int revealed =
        (-nearer > weak[x] ? kWeakRevealed : 0) |
        (strongly_farther ? (z > farthest[x] + strong[x] ? kStrongRevealed : kAmbiguousRevealed) : 0);
    const bool known = (z > 0.0F) & (expected[x] > 0.0F);
    bits[x] = static_cast<std::uint8_t>((moved | revealed) & (known ? 0xFF : 0));
    labels[x] = known ? PixelLabel::kStatic : PixelLabel::kNotKnown;
  }
  // A hole of the model proves nothing, unless this run has seen something farther in it. But a dynamic
  // region may cover it.
  int holes = 0;
  const std::uint8_t* is_island = bounds.is_island.data();
  for (int x = 0; x < width; ++x) holes |= !(expected[x] > 0.0F);
  if (holes == 0 && bounds.is_all_mapped) return;
  constexpr float kSameSurface = 1.1F;  // max ratio of depths within a block
  const float* around = bounds.around_hole_m.data();
  const float* background = bounds.background_m.data();
  for (int x = 0; x < width; ++x) {
    const float z = live[x];
    if ((expected[x] > 0.0F && is_island[x] == 0) || !(z > 0.0F) || (bits[x] & kStrongMoved) != 0) continue;
    if (z < kSameSurface * bounds.moving_m[x]) {
      bits[x] = kWeakMoved | kStrongMoved;
      continue;
    }
    if (background[x] - z > strong[x]) {
      bits[x] = kWeakMoved | (z < nearest[x] - strong[x] ? kStrongMoved : kAmbiguousMoved);
      continue;
    }
    if (z < kSameSurface * bounds.come_m[x]) bits[x] = kWeakMoved | kInHole;
    if (around[x] == kNoDepth_m) continue;
    const float sigma = facing_sigma_m(config.noise, around[x], config.model_sigma_m, misfit_per_m);
    if (z < around[x] - config.strong_sigmas * sigma) bits[x] = kWeakMoved | kInHole;
  }
}

// Combines the bits of all pixels of each block in a row of blocks.
void gather_blocks(const std::uint8_t* evidence, int width, int rows_px, std::uint8_t* row_bits,
                   std::uint8_t* blocks) {
  std::copy_n(evidence, width, row_bits);
  for (int y = 1; y < rows_px; ++y) {
    const std::uint8_t* row = evidence + static_cast<std::size_t>(y) * width;
    for (int x = 0; x < width; ++x) row_bits[x] |= row[x];
  }
  const int columns = blocks_along(width);
  for (int column = 0; column < columns; ++column) {
    const std::uint8_t* bits = row_bits + column * kBlock_px;  // padded with 0
    blocks[column] = static_cast<std::uint8_t>(bits[0] | bits[1] | bits[2] | bits[3]);
  }
}

// Resolves ambiguous pixels, which are behind a near edge's reach, such as those of a ball behind a box. They
// are dynamic if no expected surface within reach is at their depth, within tolerance. A block with an edge
// represents its two sides, not the depths between them.
std::uint8_t resolve_ambiguous(const DepthImage& depth_m, int column, int row, const ForegroundConfig& config,
                               const StaticExpectation& expected, std::vector<std::uint8_t>& bits) {
  const ExpectedBounds& bounds = expected.bounds;
  const float misfit_per_m = expected.misfit_per_m;
  constexpr int kLanes = kBlock_px * kBlock_px;
  std::array<std::size_t, kLanes> pixel;
  std::array<float, kLanes> depth, tolerance;
  std::array<int, kLanes> is_expected;
  int count = 0;
  for (int y = row * kBlock_px; y < std::min((row + 1) * kBlock_px, depth_m.height); ++y) {
    for (int x = column * kBlock_px; x < std::min((column + 1) * kBlock_px, depth_m.width); ++x) {
      const std::size_t i = depth_m.index(x, y);
      if ((bits[i] & kAmbiguousMoved) == 0) continue;
      pixel[count] = i;
      depth[count] = depth_m.pixels[i];
      tolerance[count] = config.strong_sigmas *
                         facing_sigma_m(config.noise, depth[count], config.model_sigma_m, misfit_per_m);
      ++count;
    }
  }
  // The rest repeat the first, so that the loop below has a constant length.
  for (int i = count; i < kLanes; ++i) {
    depth[i] = depth[0];
    tolerance[i] = tolerance[0];
  }
  is_expected.fill(0);
  const int reach = bounds.reach[bounds.grid.at(column, row)];
  for (int v = std::max(row - reach, 0); v <= std::min(row + reach, bounds.grid.rows - 1); ++v) {
    for (int u = std::max(column - reach, 0); u <= std::min(column + reach, bounds.grid.columns - 1); ++u) {
      const float nearest = bounds.nearest_m[bounds.grid.at(u, v)];
      const float farthest = bounds.farthest_m[bounds.grid.at(u, v)];
      for (int i = 0; i < kLanes; ++i) {
        const float from_nearest = depth[i] - nearest, from_farthest = depth[i] - farthest;
        is_expected[i] |=
            (std::abs(from_nearest) <= tolerance[i]) | (std::abs(from_farthest) <= tolerance[i]);
      }
    }
  }
  std::uint8_t found = 0;
  for (int i = 0; i < count; ++i) {
    if (is_expected[i]) continue;
    bits[pixel[i]] |= kStrongMoved;
    found = kStrongMoved;
  }
  return found;
}

// Returns true if at least 3/4 of a block's known pixels are farther than the model.
bool is_revealed(const DepthImage& depth_m, const DepthImage& expected_m, int column, int row,
                 const std::vector<std::uint8_t>& evidence) {
  int known = 0, revealed = 0;
  for (int y = row * kBlock_px; y < std::min((row + 1) * kBlock_px, depth_m.height); ++y) {
    for (int x = column * kBlock_px; x < std::min((column + 1) * kBlock_px, depth_m.width); ++x) {
      const std::size_t i = depth_m.index(x, y);
      const bool is_known = (depth_m.pixels[i] > 0.0F) & (expected_m.pixels[i] > 0.0F);
      const std::uint8_t bits = kWeakRevealed | kStrongRevealed | kAmbiguousRevealed;
      known += is_known;
      revealed += is_known & ((evidence[i] & bits) != 0);
    }
  }
  return known > 0 && 4 * revealed >= 3 * known;
}

}  // namespace

void PixelEvidence::resize(int width_px, int height_px) {
  const auto width = static_cast<std::size_t>(width_px);
  bits.resize(width * static_cast<std::size_t>(height_px));
  for (auto* values : {&row.weak_m, &row.strong_m, &row.nearest_m, &row.farthest_m, &row.around_hole_m,
                       &row.background_m, &row.come_m, &row.moving_m})
    values->resize(width);
  row.keep.resize(width);
  row.is_all_mapped = false;
  row.is_island.resize(width);
  row.bits.assign(static_cast<std::size_t>(blocks_along(width_px)) * kBlock_px, 0);
}

void weigh_pixels(const DepthImage& depth_m, const StaticExpectation& expected,
                  const std::vector<std::uint8_t>& before, const ForegroundConfig& settings,
                  PixelEvidence& evidence, LabelImage& labels) {
  const ExpectedBounds& bounds = expected.bounds;
  const ForegroundConfig config = settings;
  const int width = depth_m.width;
  const BlockGrid grid = bounds.grid;
  evidence.blocks.evidence.assign(grid.size(), 0);
  for (int row = 0; row < grid.rows; ++row) {
    stretch_bounds(config, bounds, before, row, width, evidence);
    stretch_unmapped(expected.unmapped, bounds, row, width, evidence.row);
    const int end = std::min((row + 1) * kBlock_px, depth_m.height);
    for (int y = row * kBlock_px; y < end; ++y) {
      weigh_row({depth_m.row(y), expected.depth_m.row(y), width}, config, evidence.row, expected.misfit_per_m,
                evidence.bits.data() + depth_m.index(0, y), labels.row(y));
    }
    std::uint8_t* blocks = evidence.blocks.evidence.data() + grid.at(0, row);
    std::uint8_t* bits = evidence.bits.data() + depth_m.index(0, row * kBlock_px);
    gather_blocks(bits, width, end - row * kBlock_px, evidence.row.bits.data(), blocks);
    const std::uint8_t* was_before = before.data() + grid.at(0, row);
    for (int column = 0; column < grid.columns; ++column) {
      if ((blocks[column] & kAmbiguousMoved) != 0)
        blocks[column] |= resolve_ambiguous(depth_m, column, row, config, expected, evidence.bits);
      if (was_before[column] == 0 || blocks[column] == 0) continue;
      const int was =
          ((was_before[column] & (kBlockMoved | kBlockMaybeMoved)) != 0 ? kMovedBefore : 0) |
          ((was_before[column] & (kBlockRevealed | kBlockMaybeRevealed)) != 0 ? kRevealedBefore : 0);
      const int x_end = std::min((column + 1) * kBlock_px, width);
      for (int y = row * kBlock_px; y < end; ++y) {
        for (int x = column * kBlock_px; x < x_end; ++x)
          evidence.bits[depth_m.index(x, y)] |= static_cast<std::uint8_t>(was);
      }
    }
  }
}

void mark_revealed_cores(const DepthImage& depth_m, const DepthImage& expected_m,
                         const ExpectedBounds& bounds, PixelEvidence& evidence) {
  const BlockGrid grid = bounds.grid;
  std::vector<std::uint8_t>& within =
      evidence.blocks.revealed_for;  // sum of revealed blocks around each block, itself included
  within.assign(grid.size(), 0);
  bool any = false;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.at(column, row);
      if ((evidence.blocks.evidence[i] & (kStrongRevealed | kAmbiguousRevealed)) == 0) continue;
      within[i] = is_revealed(depth_m, expected_m, column, row, evidence.bits) ? 1 : 0;
      any = any || within[i] != 0;
    }
  }
  if (!any) return;
  constexpr int kMostReach = 3;
  std::vector<std::uint8_t>& level = evidence.blocks.near_strong;
  level = within;
  for (int reach = 1; reach <= kMostReach; ++reach) {
    spread(grid, level, 1, Fewer{}, evidence.blocks.along_rows, level);
    for (std::size_t i = 0; i < level.size(); ++i)
      within[i] = static_cast<std::uint8_t>(within[i] + level[i]);
  }
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.at(column, row);
      if (within[i] <= (bounds.reach[i] + 1) / 2) continue;
      for (int y = row * kBlock_px; y < std::min((row + 1) * kBlock_px, depth_m.height); ++y) {
        for (int x = column * kBlock_px; x < std::min((column + 1) * kBlock_px, depth_m.width); ++x)
          evidence.bits[depth_m.index(x, y)] |= kRevealedCore;
      }
    }
  }
}

void drop_far_weak(const DepthImage& depth_m, int reach_px, const BlockGrid& grid, PixelEvidence& evidence) {
  std::vector<std::uint8_t>& near = evidence.blocks.near_strong;
  near = evidence.blocks.evidence;
  int reach = 0;
  for (const int wanted = blocks_along(reach_px); reach < wanted;) {
    const int step = std::min(2 * reach + 1, wanted - reach);
    spread(grid, near, step, Union{}, evidence.blocks.along_rows, near);
    reach += step;
  }
  for (std::uint8_t& bits : near) {
    bits = static_cast<std::uint8_t>(0xFF & ~((bits & kStrongMoved) != 0 ? 0 : kWeakMoved) &
                                     ~((bits & kStrongRevealed) != 0 ? 0 : kWeakRevealed));
  }
  for (int y = 0; y < depth_m.height; ++y) {
    if (y % kBlock_px == 0)
      stretch(near.data() + grid.at(0, y / kBlock_px), depth_m.width, evidence.row.keep.data());
    std::uint8_t* bits = evidence.bits.data() + depth_m.index(0, y);
    // Pixels in holes of the model stay, since nothing but the region that they belong to can tell about
    // them.
    for (int x = 0; x < depth_m.width; ++x) {
      static_assert(kInHole == kWeakMoved << 5);
      bits[x] &= static_cast<std::uint8_t>(evidence.row.keep[x] | (bits[x] >> 5 & bits[x] & kWeakMoved));
    }
  }
}

}  // namespace roomradar
