// foreground.cpp: the steps of one frame, and the tests that accept regions.
#include "dynamic/foreground/foreground.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <string>

#include "mapping/types/depth_noise.hpp"

namespace roomradar {

void follow_misfit(const DepthImage& depth_m, const DepthImage& expected_m, const DepthNoise& noise,
                   StaticResidual& fit) {
  constexpr int kStep_px = 8;
  constexpr int kLeastSamples = 100;
  constexpr float kLargest_per_m = 0.03F;
  constexpr float kLeast_per_m = 0.0006F, kMost_per_m = 0.007F;
  constexpr float kShrink = 0.1F;      // fraction of the difference, per frame
  constexpr double kOneSigma = 0.683;  // fraction of a normal distribution within one sigma
  const float bins_per_m = static_cast<float>(fit.histogram.size()) / kLargest_per_m;

  fit.histogram.fill(0);
  int samples = 0;
  double noise2 = 0.0;
  for (int y = kStep_px / 2; y < depth_m.height; y += kStep_px) {
    const float* live = depth_m.row(y);
    const float* expected = expected_m.row(y);
    for (int x = kStep_px / 2; x < depth_m.width; x += kStep_px) {
      if (!(live[x] > 0.0F) || !(expected[x] > 0.0F)) continue;
      const float apart = std::abs(live[x] - expected[x]) / (live[x] * expected[x]);
      if (apart >= kLargest_per_m) continue;
      ++fit.histogram[std::min(static_cast<std::size_t>(apart * bins_per_m), fit.histogram.size() - 1)];
      const float sigma_per_m = depth_sigma_m(noise, expected[x]) / (expected[x] * expected[x]);
      noise2 += sigma_per_m * sigma_per_m;
      ++samples;
    }
  }
  if (samples < kLeastSamples) return;
  std::size_t bin = 0;
  for (double within = 0.0; bin < fit.histogram.size(); ++bin) {
    within += fit.histogram[bin];
    if (within >= kOneSigma * samples) break;
  }
  const float spread_per_m = (static_cast<float>(bin) + 0.5F) / bins_per_m;
  const float misfit2 = spread_per_m * spread_per_m - static_cast<float>(noise2 / samples);
  const float now = std::clamp(std::sqrt(std::max(misfit2, 0.0F)), kLeast_per_m, kMost_per_m);
  fit.misfit_per_m = now > fit.misfit_per_m ? now : fit.misfit_per_m + kShrink * (now - fit.misfit_per_m);
}

namespace {

// One of the two differences from the model: moved or revealed.
struct Difference {
  RegionBits bits;
  std::uint8_t block, block_maybe;
  float min_strong_of_all;
  PixelLabel label;
};

enum class Belief { kNone, kMaybe, kSure };

bool is_large(const ConnectedComponent& region, const Intrinsics& camera, const ForegroundConfig& config,
              float times = 1.0F) {
  const float area_m2 = region.depth2_m2 / static_cast<float>(camera.fx_px * camera.fy_px);
  return static_cast<float>(region.pixels) >= times * static_cast<float>(config.min_region_px) &&
         area_m2 >= times * config.min_region_m2;
}

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
  if (is_large(region, camera, config, was ? kSeenBefore : kAtFirstSight)) return Belief::kSure;
  return is_large(region, camera, config) ? Belief::kMaybe : Belief::kNone;
}

// Returns true if evidence in a block is more than the flicker of an edge far away: the block has a model, or
// all blocks around it have evidence as well.
bool is_firm(const ForegroundState& state, int column, int row, std::uint8_t strong) {
  const BlockGrid& grid = state.bounds.grid;
  const std::vector<std::uint8_t>& evidence = state.evidence.blocks.evidence;
  if ((evidence[grid.at(column, row)] & strong) == 0) return false;
  if (state.bounds.model_m[grid.at(column, row)] > 0.0F) return true;
  for (int v = std::max(row - 1, 0); v <= std::min(row + 1, grid.rows - 1); ++v)
    for (int u = std::max(column - 1, 0); u <= std::min(column + 1, grid.columns - 1); ++u)
      if ((evidence[grid.at(u, v)] & strong) == 0) return false;
  return true;
}

// Sets state.firm: per region, whether any of its blocks has firm evidence.
void find_firm_regions(const DepthImage& depth_m, std::uint8_t strong, ForegroundState& state) {
  const auto width = static_cast<std::uint32_t>(depth_m.width);
  state.firm.reserve(depth_m.pixels.size());
  state.firm.assign(state.regions.runs.size(), 0);
  for (const PixelRun& run : state.regions.runs) {
    const std::uint32_t y = run.first / width;
    for (std::uint32_t x = run.first - y * width; x <= run.last - y * width && state.firm[run.region] == 0;
         x += kBlock_px)
      state.firm[run.region] =
          is_firm(state, static_cast<int>(x) / kBlock_px, static_cast<int>(y) / kBlock_px, strong) ? 1 : 0;
  }
}

// Labels the accepted regions of one kind; returns their number of pixels.
std::size_t label_regions(const DepthImage& depth_m, const Difference& difference, const Intrinsics& camera,
                          const ForegroundConfig& config, ForegroundState& state, LabelImage& labels) {
  const int max_gap_px =
      std::min(256, static_cast<int>(config.max_gap_rad * static_cast<float>(camera.fx_px)));
  find_components(depth_m, state.evidence.bits, difference.bits, camera,
                  {.noise = config.noise, .max_gap_px = max_gap_px}, state.regions);
  const bool is_moved = difference.label == PixelLabel::kMoved;
  if (is_moved) find_firm_regions(depth_m, difference.bits.strong, state);
  const auto width = static_cast<std::uint32_t>(depth_m.width);
  std::size_t labelled = 0;
  for (const PixelRun& run : state.regions.runs) {
    const ConnectedComponent& region = state.regions.regions[run.region];
    const bool is_flicker = is_moved && state.firm[run.region] == 0;
    const Belief belief = is_flicker ? Belief::kNone : belief_in(region, difference, camera, config);
    if (belief == Belief::kSure) {
      std::fill(labels.pixels.begin() + run.first, labels.pixels.begin() + run.last + 1, difference.label);
      labelled += run.last - run.first + 1;
    } else {
      for (std::uint32_t i = run.first; i <= run.last; ++i)
        if ((state.evidence.bits[i] & difference.bits.strong) != 0) labels.pixels[i] = PixelLabel::kNotKnown;
      if (is_moved && is_large(region, camera, config))
        for (std::uint32_t i = run.first; i <= run.last; ++i)
          if ((state.evidence.bits[i] & kInHole) != 0 && labels.pixels[i] == PixelLabel::kNotKnown)
            labels.pixels[i] = PixelLabel::kUnmapped;
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

ForegroundCounts mark_foreground(const PosedDepth& measured, const DepthImage& expected_depth_m,
                                 const ForegroundConfig& config, ForegroundState& state, LabelImage& labels,
                                 MaskImage& dynamic_mask) {
  const DepthImage& depth_m = measured.depth_m;
  const Intrinsics& camera = measured.camera;
  assert(depth_m.width == expected_depth_m.width && depth_m.height == expected_depth_m.height);
  assert(depth_m.width == camera.width_px && depth_m.height == camera.height_px);
  if (labels.width != depth_m.width || labels.height != depth_m.height)
    labels.resize(depth_m.width, depth_m.height);
  if (dynamic_mask.width != depth_m.width || dynamic_mask.height != depth_m.height)
    dynamic_mask.resize(depth_m.width, depth_m.height);
  if (depth_m.pixels.empty()) return {};
  state.evidence.resize(depth_m.width, depth_m.height);

  follow_misfit(depth_m, expected_depth_m, config.noise, state.fit);
  find_bounds({expected_depth_m, camera, measured.T_world_camera}, config, state.fit.misfit_per_m,
              state.unmapped, state.bounds);
  see_what_came(depth_m, state.bounds.model_m, config.noise, state.unmapped);
  warp_history(state.memory, depth_m, camera, measured.T_world_camera, state.before);
  const StaticExpectation expected{.depth_m = expected_depth_m,
                                   .bounds = state.bounds,
                                   .unmapped = state.unmapped,
                                   .misfit_per_m = state.fit.misfit_per_m};
  weigh_pixels(depth_m, expected, state.before, config, state.evidence, labels);
  mark_revealed_cores(depth_m, expected_depth_m, state.bounds, state.evidence);
  drop_far_weak(depth_m, config.weak_reach_px, state.bounds.grid, state.evidence);

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
  store_history(camera, measured.T_world_camera, state.memory);

  for (int y = 0; y < depth_m.height; ++y) {
    const float* live = depth_m.row(y);
    const PixelLabel* label = labels.row(y);
    std::uint8_t* mask = dynamic_mask.row(y);
    int valid = 0, not_known = 0;
    for (int x = 0; x < depth_m.width; ++x) {
      valid += live[x] > 0.0F;
      not_known +=
          (live[x] > 0.0F) & (label[x] == PixelLabel::kNotKnown || label[x] == PixelLabel::kUnmapped);
    }
    for (int x = 0; x < depth_m.width; ++x) mask[x] = label[x] == PixelLabel::kMoved ? 255 : 0;
    counts.valid += static_cast<std::size_t>(valid);
    counts.not_known += static_cast<std::size_t>(not_known);
  }
  see_background(depth_m, dynamic_mask, state.bounds.model_m, config.noise, state.unmapped);
  return counts;
}

}  // namespace roomradar
