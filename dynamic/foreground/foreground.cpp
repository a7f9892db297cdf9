// foreground.cpp: evidence of each pixel, and regions that are accepted.
#include "dynamic/foreground/foreground.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace roomradar {
namespace {

// Evidence bits of one pixel.
constexpr std::uint8_t kWeakMoved = 1, kStrongMoved = 2, kAmbiguousMoved = 4, kWeakRevealed = 8,
                       kStrongRevealed = 16, kAmbiguousRevealed = 32, kMovedBefore = 64,
                       kRevealedBefore = 128;

// In a hole of the model, together with kWeakMoved. Shares a bit, since nothing is revealed in a hole.
constexpr std::uint8_t kInHole = kAmbiguousRevealed;

// Revealed pixels that are surrounded by revealed pixels for longer than an edge error. Shares a bit.
constexpr std::uint8_t kRevealedCore = kAmbiguousMoved;

struct Union {
  std::uint8_t operator()(std::uint8_t a, std::uint8_t b) const { return static_cast<std::uint8_t>(a | b); }
};
struct Fewer {
  std::uint8_t operator()(std::uint8_t a, std::uint8_t b) const { return b < a ? b : a; }
};

// Expands the bounds of a row of blocks to one value per pixel.
void stretch_bounds(const ForegroundConfig& config, int row, int width, ForegroundState& state) {
  const ExpectedBounds& bounds = state.bounds;
  const std::size_t begin = bounds.grid.at(0, row);
  stretch(bounds.sigma_m.data() + begin, width, state.strong_m.data());
  stretch(bounds.nearest_in_reach_m.data() + begin, width, state.nearest_m.data());
  stretch(bounds.farthest_in_reach_m.data() + begin, width, state.farthest_m.data());
  stretch(bounds.nearest_around_hole_m.data() + begin, width, state.around_hole_m.data());
  for (int x = 0; x < width; ++x) {
    const float sigma = state.strong_m[x];
    const bool was = state.before[begin + x / kBlock_px] != 0;
    const float factor = was ? config.hysteresis : 1.0F;
    state.weak_m[x] = factor * config.weak_sigmas * sigma;
    state.strong_m[x] = factor * config.strong_sigmas * sigma;
  }
}

// Computes the evidence of one row of pixels, without their neighbours.
void weigh_row(const float* live, const float* expected, int width, const ForegroundConfig& config,
               const ForegroundState& state, std::uint8_t* evidence, PixelLabel* labels) {
  const float* weak = state.weak_m.data();
  const float* strong = state.strong_m.data();
  const float* nearest = state.nearest_m.data();
  const float* farthest = state.farthest_m.data();
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
    evidence[x] = static_cast<std::uint8_t>((moved | revealed) & (known ? 0xFF : 0));
    labels[x] = known ? PixelLabel::kStatic : PixelLabel::kNotKnown;
  }
  // Holes of the model prove nothing, but a dynamic region may cover them.
  int holes = 0;
  for (int x = 0; x < width; ++x) holes |= !(expected[x] > 0.0F);
  if (holes == 0) return;
  const float* around = state.around_hole_m.data();
  for (int x = 0; x < width; ++x) {
    if (expected[x] > 0.0F || !(live[x] > 0.0F) || around[x] == kNoDepth_m) continue;
    const float sigma = facing_sigma_m(around[x], config.model_sigma_m, state.fit.misfit_per_m);
    if (live[x] < around[x] - config.strong_sigmas * sigma) evidence[x] = kWeakMoved | kInHole;
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
                               ForegroundState& state) {
  const ExpectedBounds& bounds = state.bounds;
  constexpr int kLanes = kBlock_px * kBlock_px;
  std::array<std::size_t, kLanes> pixel;
  std::array<float, kLanes> depth, tolerance;
  std::array<int, kLanes> is_expected;
  int count = 0;
  for (int y = row * kBlock_px; y < std::min((row + 1) * kBlock_px, depth_m.height); ++y) {
    for (int x = column * kBlock_px; x < std::min((column + 1) * kBlock_px, depth_m.width); ++x) {
      const std::size_t i = depth_m.index(x, y);
      if ((state.evidence[i] & kAmbiguousMoved) == 0) continue;
      pixel[count] = i;
      depth[count] = depth_m.pixels[i];
      tolerance[count] =
          config.strong_sigmas * facing_sigma_m(depth[count], config.model_sigma_m, state.fit.misfit_per_m);
      ++count;
    }
  }
  for (int i = count; i < kLanes; ++i) {  // the rest repeat the first, so the loop below has a constant
                                          // length
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
    state.evidence[pixel[i]] |= kStrongMoved;
    found = kStrongMoved;
  }
  return found;
}

void weigh_pixels(const DepthImage& depth_m, const DepthImage& expected_m, const ForegroundConfig& settings,
                  ForegroundState& state, LabelImage& labels) {
  const ForegroundConfig config = settings;
  const int width = depth_m.width;
  const BlockGrid grid = state.bounds.grid;
  state.block_evidence.assign(grid.size(), 0);
  for (int row = 0; row < grid.rows; ++row) {
    stretch_bounds(config, row, width, state);
    const int end = std::min((row + 1) * kBlock_px, depth_m.height);
    for (int y = row * kBlock_px; y < end; ++y) {
      weigh_row(depth_m.row(y), expected_m.row(y), width, config, state,
                state.evidence.data() + depth_m.index(0, y), labels.row(y));
    }
    std::uint8_t* blocks = state.block_evidence.data() + grid.at(0, row);
    std::uint8_t* evidence = state.evidence.data() + depth_m.index(0, row * kBlock_px);
    gather_blocks(evidence, width, end - row * kBlock_px, state.row_bits.data(), blocks);
    const std::uint8_t* before = state.before.data() + grid.at(0, row);
    for (int column = 0; column < grid.columns; ++column) {
      if ((blocks[column] & kAmbiguousMoved) != 0)
        blocks[column] |= resolve_ambiguous(depth_m, column, row, config, state);
      if (before[column] == 0 || blocks[column] == 0) continue;
      const int was = ((before[column] & (kBlockMoved | kBlockMaybeMoved)) != 0 ? kMovedBefore : 0) |
                      ((before[column] & (kBlockRevealed | kBlockMaybeRevealed)) != 0 ? kRevealedBefore : 0);
      const int x_end = std::min((column + 1) * kBlock_px, width);
      for (int y = row * kBlock_px; y < end; ++y) {
        for (int x = column * kBlock_px; x < x_end; ++x)
          state.evidence[depth_m.index(x, y)] |= static_cast<std::uint8_t>(was);
      }
    }
  }
}

// Returns true if at least 3/4 of a block's known pixels are farther than the model.
bool is_revealed(const DepthImage& depth_m, const DepthImage& expected_m, int column, int row,
                 const ForegroundState& state) {
  int known = 0, revealed = 0;
  for (int y = row * kBlock_px; y < std::min((row + 1) * kBlock_px, depth_m.height); ++y) {
    for (int x = column * kBlock_px; x < std::min((column + 1) * kBlock_px, depth_m.width); ++x) {
      const std::size_t i = depth_m.index(x, y);
      const bool is_known = (depth_m.pixels[i] > 0.0F) & (expected_m.pixels[i] > 0.0F);
      const std::uint8_t bits = kWeakRevealed | kStrongRevealed | kAmbiguousRevealed;
      known += is_known;
      revealed += is_known & ((state.evidence[i] & bits) != 0);
    }
  }
  return known > 0 && 4 * revealed >= 3 * known;
}

// A model edge displaced by an error reveals a strip of background as wide as the error; a removed object was
// wider. Marks the blocks that have revealed blocks to all sides for half an edge's error.
void mark_revealed_cores(const DepthImage& depth_m, const DepthImage& expected_m, ForegroundState& state) {
  const BlockGrid grid = state.bounds.grid;
  std::vector<std::uint8_t>& within = state.revealed_for;  // number of revealed blocks to all sides, itself
                                                           // included
  within.assign(grid.size(), 0);
  bool any = false;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.at(column, row);
      if ((state.block_evidence[i] & (kStrongRevealed | kAmbiguousRevealed)) == 0) continue;
      within[i] = is_revealed(depth_m, expected_m, column, row, state) ? 1 : 0;
      any = any || within[i] != 0;
    }
  }
  if (!any) return;
  constexpr int kMostReach = 3;
  std::vector<std::uint8_t>& level = state.near_strong;
  level = within;
  for (int reach = 1; reach <= kMostReach; ++reach) {
    spread(grid, level, 1, Fewer{}, state.along_rows, level);
    for (std::size_t i = 0; i < level.size(); ++i)
      within[i] = static_cast<std::uint8_t>(within[i] + level[i]);
  }
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.at(column, row);
      if (within[i] <= (state.bounds.reach[i] + 1) / 2) continue;
      for (int y = row * kBlock_px; y < std::min((row + 1) * kBlock_px, depth_m.height); ++y) {
        for (int x = column * kBlock_px; x < std::min((column + 1) * kBlock_px, depth_m.width); ++x)
          state.evidence[depth_m.index(x, y)] |= kRevealedCore;
      }
    }
  }
}

// Drops weak evidence that is far from strong evidence.
void drop_far_weak(const DepthImage& depth_m, int reach_px, ForegroundState& state) {
  const BlockGrid grid = state.bounds.grid;
  std::vector<std::uint8_t>& near = state.near_strong;
  near = state.block_evidence;
  int reach = 0;
  for (const int wanted = blocks_along(reach_px); reach < wanted;) {
    const int step = std::min(2 * reach + 1, wanted - reach);
    spread(grid, near, step, Union{}, state.along_rows, near);
    reach += step;
  }
  for (std::uint8_t& bits : near) {
    bits = static_cast<std::uint8_t>(0xFF & ~((bits & kStrongMoved) != 0 ? 0 : kWeakMoved) &
                                     ~((bits & kStrongRevealed) != 0 ? 0 : kWeakRevealed));
  }
  for (int y = 0; y < depth_m.height; ++y) {
    if (y % kBlock_px == 0)
      stretch(near.data() + grid.at(0, y / kBlock_px), depth_m.width, state.keep.data());
    std::uint8_t* evidence = state.evidence.data() + depth_m.index(0, y);
    for (int x = 0; x < depth_m.width; ++x) evidence[x] &= state.keep[x];
  }
}

// One of the two differences from the model: moved or revealed.
struct Difference {
  RegionBits bits;
  std::uint8_t block, block_maybe;
  float min_strong_of_all;
  PixelLabel label;
};

enum class Belief { kNone, kMaybe, kSure };

Belief belief_in(const ConnectedComponent& region, const Difference& difference, const Intrinsics& camera,
                 const ForegroundConfig& config) {
  constexpr float kAtFirstSight = 3.0F;  // times the least size
  constexpr float kSeenBefore = 0.75F;
  const auto pixels = static_cast<float>(region.pixels);
  const auto strong = static_cast<float>(region.strong);
  const auto judged = static_cast<float>(region.pixels - region.ambiguous);
  const bool was = 2 * region.before >= region.pixels;
  const float part = was ? 0.5F : 1.0F;
  if (difference.bits.core != 0 && region.core == 0) return Belief::kNone;
  if (region.strong == 0 || strong < part * difference.min_strong_of_all * pixels ||
      strong < part * config.min_strong_fraction * judged)
    return Belief::kNone;
  const float area_m2 = region.depth2_m2 / static_cast<float>(camera.fx_px * camera.fy_px);
  const auto has = [&](float times) {
    return pixels >= times * static_cast<float>(config.min_region_px) &&
           area_m2 >= times * config.min_region_m2;
  };
  if (has(was ? kSeenBefore : kAtFirstSight)) return Belief::kSure;
  return has(1.0F) ? Belief::kMaybe : Belief::kNone;
}

// Labels the accepted regions of one kind; returns their number of pixels.
std::size_t label_regions(const DepthImage& depth_m, const Difference& difference, const Intrinsics& camera,
                          const ForegroundConfig& config, ForegroundState& state, LabelImage& labels) {
  find_components(depth_m, state.evidence, difference.bits, camera, state.regions);
  const auto width = static_cast<std::uint32_t>(depth_m.width);
  std::size_t labelled = 0;
  for (const PixelRun& run : state.regions.runs) {
    const Belief belief = belief_in(state.regions.regions[run.region], difference, camera, config);
    if (belief == Belief::kSure) {
      std::fill(labels.pixels.begin() + run.first, labels.pixels.begin() + run.last + 1, difference.label);
      labelled += run.last - run.first + 1;
    } else {
      for (std::uint32_t i = run.first; i <= run.last; ++i)
        if ((state.evidence[i] & difference.bits.strong) != 0) labels.pixels[i] = PixelLabel::kNotKnown;
      if (belief == Belief::kNone) continue;
    }
    const std::uint8_t bit = belief == Belief::kSure ? difference.block : difference.block_maybe;
    const std::uint32_t row = run.first / width;
    std::uint8_t* blocks =
        state.memory.blocks.data() + state.bounds.grid.at(0, static_cast<int>(row) / kBlock_px);
    for (std::uint32_t column = (run.first - row * width) / kBlock_px;
         column <= (run.last - row * width) / kBlock_px; ++column)
      blocks[column] |= bit;
  }
  return labelled;
}

}  // namespace

ForegroundCounts mark_foreground(const DepthImage& depth_m, const DepthImage& expected_depth_m,
                                 const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                                 const ForegroundConfig& config, ForegroundState& state, LabelImage& labels,
                                 MaskImage& dynamic_mask) {
  assert(depth_m.width == expected_depth_m.width && depth_m.height == expected_depth_m.height);
  assert(depth_m.width == camera.width_px && depth_m.height == camera.height_px);
  const std::size_t pixels = depth_m.pixels.size();
  const auto width = static_cast<std::size_t>(depth_m.width);
  if (labels.width != depth_m.width || labels.height != depth_m.height)
    labels.resize(depth_m.width, depth_m.height);
  if (dynamic_mask.width != depth_m.width || dynamic_mask.height != depth_m.height)
    dynamic_mask.resize(depth_m.width, depth_m.height);
  if (pixels == 0) return {};
  state.evidence.resize(pixels);
  for (auto* row :
       {&state.weak_m, &state.strong_m, &state.nearest_m, &state.farthest_m, &state.around_hole_m})
    row->resize(width);
  state.keep.resize(width);
  state.row_bits.assign(static_cast<std::size_t>(blocks_along(depth_m.width)) * kBlock_px, 0);

  follow_misfit(depth_m, expected_depth_m, state.fit);
  find_bounds(expected_depth_m, camera, config, state.fit.misfit_per_m, state.bounds);
  warp_history(state.memory, depth_m, camera, T_world_camera, state.before);
  weigh_pixels(depth_m, expected_depth_m, config, state, labels);
  mark_revealed_cores(depth_m, expected_depth_m, state);
  drop_far_weak(depth_m, config.weak_reach_px, state);

  state.memory.grid = state.bounds.grid;
  state.memory.blocks.assign(state.bounds.grid.size(), 0);
  const Difference moved{{kWeakMoved, kStrongMoved, kInHole, kMovedBefore, 0},
                         kBlockMoved,
                         kBlockMaybeMoved,
                         config.min_strong_of_all,
                         PixelLabel::kMoved};
  const Difference revealed{
      {kWeakRevealed, kStrongRevealed, kAmbiguousRevealed, kRevealedBefore, kRevealedCore},
      kBlockRevealed,
      kBlockMaybeRevealed,
      config.min_strong_of_all_revealed,
      PixelLabel::kRevealed};
  ForegroundCounts counts;
  counts.moved = label_regions(depth_m, moved, camera, config, state, labels);
  counts.revealed = label_regions(depth_m, revealed, camera, config, state, labels);
  store_history(camera, T_world_camera, state.memory);

  for (int y = 0; y < depth_m.height; ++y) {
    const float* live = depth_m.row(y);
    const PixelLabel* label = labels.row(y);
    std::uint8_t* mask = dynamic_mask.row(y);
    int valid = 0, not_known = 0;
    for (int x = 0; x < depth_m.width; ++x) {
      valid += live[x] > 0.0F;
      not_known += (live[x] > 0.0F) & (label[x] == PixelLabel::kNotKnown);
    }
    for (int x = 0; x < depth_m.width; ++x) mask[x] = label[x] == PixelLabel::kMoved ? 255 : 0;
    counts.valid += static_cast<std::size_t>(valid);
    counts.not_known += static_cast<std::size_t>(not_known);
  }
  return counts;
}

}  // namespace roomradar
