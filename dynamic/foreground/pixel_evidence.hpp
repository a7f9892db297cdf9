// pixel_evidence.hpp: evidence per pixel that the measured depth differs from the static model.
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
  kNotKnown,  ///< no measured or expected depth, or a region too small or too new to decide
  kStatic,    ///< agrees with the static model within noise and pose error
  kMoved,     ///< nearer than the static model, as for an object in front of it
  kRevealed,  ///< uncovered background: farther than the static model, as after an object's removal
  kUnmapped,  ///< in front of space without a model, and nothing shows that it moved
};
using LabelImage = Image<PixelLabel>;

/// Evidence bits of one pixel. A weak pixel's depth differs from the model by more than RowBounds::weak_m. A
/// strong pixel's depth differs by more than RowBounds::strong_m. An ambiguous pixel's difference is strong,
/// but a model edge displaced within its error could explain it. kMovedBefore and kRevealedBefore are set
/// where the previous frame had a moved or a revealed region.
inline constexpr std::uint8_t kWeakMoved = 1, kStrongMoved = 2, kAmbiguousMoved = 4, kWeakRevealed = 8,
                              kStrongRevealed = 16, kAmbiguousRevealed = 32, kMovedBefore = 64,
                              kRevealedBefore = 128;

/// Set together with kWeakMoved if the pixel is in a hole or island of the model (ExpectedBounds) and no
/// strong evidence says more. Shares a bit with kAmbiguousRevealed, since no pixel is farther than the model
/// in a hole.
inline constexpr std::uint8_t kInHole = kAmbiguousRevealed;

/// Set on pixels of uncovered background by mark_revealed_cores(). Shares a bit with kAmbiguousMoved, since
/// such a pixel is never nearer than the model.
inline constexpr std::uint8_t kRevealedCore = kAmbiguousMoved;

/// Thresholds, depth bounds and scratch for one row of pixels. Each vector has one value per pixel.
struct RowBounds {
  std::vector<float> weak_m, strong_m;  ///< min differences from the model for weak and strong evidence
  /// Of the pixel's block, from ExpectedBounds.
  std::vector<float> nearest_m, farthest_m, around_hole_m, background_m;
  /// Depth of a surface that has come into the pixel's block in unmapped space, and of one that moves; 0:
  /// none.
  std::vector<float> come_m, moving_m;
  bool is_all_mapped = false;            ///< true: no hole or island fills any block of the row
  std::vector<std::uint8_t> is_island;   ///< of the pixel's block, from ExpectedBounds
  std::vector<std::uint8_t> keep, bits;  ///< scratch
};

/// Evidence bits per block of 4 x 4 pixels.
struct BlockEvidence {
  std::vector<std::uint8_t> evidence;      ///< union of the bits of a block's pixels
  std::vector<std::uint8_t> near_strong;   ///< scratch
  std::vector<std::uint8_t> along_rows;    ///< scratch
  std::vector<std::uint8_t> revealed_for;  ///< scratch
};

/// Evidence of one frame, and scratch buffers, reused from frame to frame.
struct PixelEvidence {
  std::vector<std::uint8_t> bits;  ///< evidence bits, one byte per pixel
  BlockEvidence blocks;
  RowBounds row;

  /// Sets the sizes for images of width_px x height_px.
  void resize(int width_px, int height_px);
};

/// What the static room looks like in this view. Refers to its parts, which must outlive it.
struct StaticExpectation {
  const DepthImage& depth_m;      ///< depth of the static model, m; 0: unknown
  const ExpectedBounds& bounds;   ///< depth range of the static room per block, for depth_m
  const UnmappedSpace& unmapped;  ///< what the run has seen in the model's holes, this frame included
  /// Standard deviation of measured minus expected inverse depth of static surfaces.
  float misfit_per_m;
};

/// Computes the evidence of all pixels. Labels a pixel kStatic if its measured and expected depth are both
/// known, else kNotKnown.
/// @param depth_m  measured depth, m, height x width, 0 = unknown
/// @param before   history bits per block, see warp_history()
void weigh_pixels(const DepthImage& depth_m, const StaticExpectation& expected,
                  const std::vector<std::uint8_t>& before, const ForegroundConfig& settings,
                  PixelEvidence& evidence, LabelImage& labels);

/// Sets kRevealedCore in blocks whose neighbourhood consists of revealed blocks (farther than the model). The
/// neighbourhood's radius is more than half the max edge error, rounded up to blocks. A model edge displaced
/// by an error reveals a strip of background that is only as wide as the error. A removed object is wider.
void mark_revealed_cores(const DepthImage& depth_m, const DepthImage& expected_m,
                         const ExpectedBounds& bounds, PixelEvidence& evidence);

/// Clears kWeakMoved of pixels without strong moved evidence within reach_px, rounded up to blocks. Does the
/// same for kWeakRevealed and revealed evidence.
void drop_far_weak(const DepthImage& depth_m, int reach_px, const BlockGrid& grid, PixelEvidence& evidence);

}  // namespace roomradar
