// expected_bounds.hpp: per block of pixels, bounds of the static model's depth, given its errors.
#pragma once
#include <cmath>
#include <vector>

#include "dynamic/foreground/foreground_config.hpp"
#include "dynamic/foreground/pixel_blocks.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// One value per block of 4 x 4 pixels, and scratch buffers. Metres along the optical axis.
struct ExpectedBounds {
  BlockGrid grid;
  std::vector<float> nearest_m, farthest_m;  ///< of the expected depths in the block; kNoDepth_m and 0: none
  /// Standard deviation of live minus expected depth, all errors combined.
  std::vector<float> sigma_m;
  /// Range of the expected depths within `reach` of the block: edges of these surfaces could be shifted into
  /// it. Nearest is kNoDepth_m if nothing within reach is nearer than the block's own surface continued;
  /// farthest is 0 if nothing is farther. Then only the pixel's own expected depth counts. Farthest is
  /// kNoDepth_m if a hole of the model is within reach.
  std::vector<float> nearest_in_reach_m, farthest_in_reach_m;
  std::vector<float> nearest_around_hole_m;  ///< within hole_reach_px of the block; kNoDepth_m: none
  std::vector<int> reach;                    ///< max shift of an edge, in blocks to each side

  // Scratch.
  std::vector<float> nearest_level_m, farthest_level_m, along_rows_m;
  std::vector<float> row_nearest_m, row_farthest_m;
};

/// Largest float: "no surface" as a nearest depth, "unbounded" as a farthest depth.
inline constexpr float kNoDepth_m = 3.402823e38F;

/// Returns the standard deviation of sensor and model combined, for a surface at depth_m that faces the
/// camera.
/// @param misfit_per_m  error of the model's inverse depth (StaticResidual::misfit_per_m)
inline float facing_sigma_m(float depth_m, float model_sigma_m, float misfit_per_m) {
  const float sensor = depth_sigma_m(depth_m);
  const float misfit = misfit_per_m * depth_m * depth_m;
  return std::sqrt(sensor * sensor + model_sigma_m * model_sigma_m + misfit * misfit);
}

/// Computes all values of `bounds`.
/// @param expected_m  depth of the static model in the camera's view, 0 = nothing there; not empty
void find_bounds(const DepthImage& expected_m, const Intrinsics& camera, const ForegroundConfig& config,
                 float misfit_per_m, ExpectedBounds& bounds);

}  // namespace roomradar
