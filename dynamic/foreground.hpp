// foreground.hpp: which pixels of a depth frame differ from the static model, and how.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

enum class PixelLabel : std::uint8_t {
  kNotKnown,  ///< no live depth, or no static model to compare it with
  kStatic,    ///< agrees with the static model as far as noise and pose error let one tell
  kMoved,     ///< nearer than the static model: something came in between
  kRevealed,  ///< farther than the static model: something was taken away
};
using LabelImage = Image<PixelLabel>;

/// All "sigmas" are of the total: sensor noise at this depth and incidence angle, and the model's own error,
/// added as variances. Strong pixels start a region, weak pixels only join one.
struct ForegroundConfig {
  float model_sigma_m = 0.004F;  ///< error of the expected depth itself; a map with 1 cm cells has about this
  float model_sigma_per_m = 0.002F;  ///< and what grows with depth: pose error, the sensor's own distortion
  float strong_sigmas = 4.0F;
  float weak_sigmas = 2.0F;
  /// How far aside an edge of the model may stand, by an error of the pose and the map's distortion.
  float edge_error_m = 0.02F;
  float edge_error_rad = 0.005F;  ///< the same by a turn of the pose, 0.3 degrees
  int hole_reach_px = 16;  ///< how far from the model's edge a pixel without expected depth is still judged
  /// How far over weak pixels a region grows from strong ones: to its rim, and not over all of a misplaced
  /// table or chair that it touches, whose weakness would then count against it.
  int weak_reach_px = 40;
  int min_region_px = 60;         ///< smaller regions are noise
  float min_region_m2 = 0.0003F;  ///< the same by size in the world: 3 cm2
  /// Of a region's pixels, those that are strong. Regions by a distorted map or a wrong pose are weak nearly
  /// everywhere (0 to 0.25 in a real kitchen mapped by poses 3 cm off); what moved is strong but for its rim.
  float min_strong_fraction = 0.4F;
  /// The same of a revealed region. What was taken away stands in the model, so the reach of its own edges
  /// eats into it: of a thing 12 cm wide, a tenth is left.
  float min_strong_fraction_revealed = 0.1F;
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ForegroundConfig& config);

/// Buffers that mark_foreground reuses from frame to frame; their content means nothing between calls.
struct ForegroundScratch {
  std::vector<float> nearest_m, farthest_m, reach_m, sigma_m;  // one value a pixel of a row
  std::vector<float> padded_m;                                 // one row of expected depth with margins
  std::vector<float> block_nearest_m, block_farthest_m;        // one value a block of pixels
  std::vector<float> window_nearest_m, window_farthest_m, window_reach_m, grown_nearest_m, grown_farthest_m,
      along_rows_m, spread_m;
  std::vector<int> window;             // blocks to each side that an edge may be off
  std::vector<std::uint8_t> evidence;  // bits, see foreground.cpp
  std::vector<std::uint8_t> steps;     // from a pixel of a region to a strong one
  std::vector<std::uint32_t> region;   // pixels of the region being grown
};

struct ForegroundCounts {
  std::size_t valid = 0;  ///< pixels with live depth
  std::size_t moved = 0;
  std::size_t revealed = 0;
  std::size_t not_known = 0;  ///< pixels with live depth but nothing to compare it with
};

/// Compares a depth frame with what the static model would show at the same pose.
///
/// @param depth_m           live depth, height x width, metres along the axis, 0 = no measurement
/// @param expected_depth_m  the static model as the same camera sees it, same size, 0 = it has nothing there
/// @param camera            of both images
/// @param scratch           reused; nothing is allocated from the second frame of a size on
/// @param labels            resized and set
/// @param moved_mask        255 where the label is kMoved, else 0; resized and set
/// The three sizes must agree (asserted).
///
/// A pixel starts a moved region only if it is nearer than the model there and either nearer than all of the
/// model within the reach of an edge's error, or at a depth that no expected surface within it has: so an
/// edge that a pose error shifted stays static, and what shows between two near edges does not. From there a
/// region grows over pixels that are nearer than the model just there, across the live surface. Where the
/// model has a hole no region starts; one may grow into it over what is nearer than all expected depth within
/// hole_reach_px. Everything else in a hole, and all of an unmapped view, is kNotKnown: a hole proves
/// nothing.
ForegroundCounts mark_foreground(const DepthImage& depth_m, const DepthImage& expected_depth_m,
                                 const Intrinsics& camera, const ForegroundConfig& config,
                                 ForegroundScratch& scratch, LabelImage& labels, MaskImage& moved_mask);

}  // namespace roomradar
