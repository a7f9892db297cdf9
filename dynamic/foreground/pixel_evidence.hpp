// pixel_evidence.hpp: how strongly each pixel differs from the static model.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic/foreground/expected_bounds.hpp"
#include "dynamic/foreground/foreground_config.hpp"
#include "dynamic/foreground/pixel_blocks.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

enum class PixelLabel : std::uint8_t {
  kNotKnown,  ///< no live depth, no static model, or a difference too small or too new to decide
  kStatic,    ///< agrees with the static model within noise and pose error
  kMoved,     ///< nearer than the static model: something came in front of it
  kRevealed,  ///< farther than the static model: something was taken away
};
using LabelImage = Image<PixelLabel>;

/// Evidence bits of one pixel.
inline constexpr std::uint8_t kWeakMoved = 1, kStrongMoved = 2, kAmbiguousMoved = 4, kWeakRevealed = 8,
                              kStrongRevealed = 16, kAmbiguousRevealed = 32, kMovedBefore = 64,
                              kRevealedBefore = 128;

/// In a hole of the model, together with kWeakMoved. Shares a bit, since nothing is revealed in a hole.
inline constexpr std::uint8_t kInHole = kAmbiguousRevealed;

/// Revealed pixels that are surrounded by revealed pixels for longer than an edge error. Shares a bit.
inline constexpr std::uint8_t kRevealedCore = kAmbiguousMoved;

/// Bounds of one row of pixels; one value per pixel.
struct RowBounds {
  std::vector<float> weak_m, strong_m;  ///< min differences from the model for weak and strong evidence
  std::vector<float> nearest_m, farthest_m, around_hole_m;
  std::vector<std::uint8_t> keep, bits;
};

/// Evidence bits per block of pixels.
struct BlockEvidence {
  std::vector<std::uint8_t> evidence;     ///< union of a block's pixels
  std::vector<std::uint8_t> near_strong;  ///< evidence bits to keep
  std::vector<std::uint8_t> along_rows;
  std::vector<std::uint8_t> revealed_for;  ///< see mark_revealed_cores()
};

/// Evidence of one frame, and the buffers of its computation, reused from frame to frame.
struct PixelEvidence {
  std::vector<std::uint8_t> bits;  ///< evidence bits, one byte per pixel
  BlockEvidence blocks;
  RowBounds row;

  /// Sets the sizes for images of width_px x height_px.
  void resize(int width_px, int height_px);
};

/// Computes the evidence of all pixels, and labels them kStatic where live depth and model are known, else
/// kNotKnown.
/// @param depth_m, expected_m  live depth and the model's depth, m, height x width, 0 = unknown
/// @param bounds       depth range of the static room per block, for expected_m
/// @param misfit_per_m  misfit between model and live depth where nothing moves
/// @param before       bits per block of the previous frame's regions
void weigh_pixels(const DepthImage& depth_m, const DepthImage& expected_m, const ForegroundConfig& settings,
                  const ExpectedBounds& bounds, float misfit_per_m, const std::vector<std::uint8_t>& before,
                  PixelEvidence& evidence, LabelImage& labels);

/// Marks revealed pixels far enough from the rim of what is revealed. A model edge displaced by an error
/// reveals a strip of background as wide as the error; a removed object was wider. Marks the blocks that have
/// revealed blocks to all sides for half an edge's error.
void mark_revealed_cores(const DepthImage& depth_m, const DepthImage& expected_m,
                         const ExpectedBounds& bounds, PixelEvidence& evidence);

/// Drops weak evidence that is farther than reach_px from strong evidence.
void drop_far_weak(const DepthImage& depth_m, int reach_px, const BlockGrid& grid, PixelEvidence& evidence);

}  // namespace roomradar
