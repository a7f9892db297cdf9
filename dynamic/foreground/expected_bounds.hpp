// expected_bounds.hpp: per-block bounds of the depths at which the static room can appear, given its errors.
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
  std::vector<float> nearest_m, farthest_m;  ///< expected depth in the block; kNoDepth_m and 0 if there is
                                             ///< none
  std::vector<float> sigma_m;                ///< of live minus expected depth, all errors combined
  /// Depth range of the model's edges that a pose error could shift into the block. farthest is kNoDepth_m if
  /// a hole is within reach. The values are kNoDepth_m and 0 if only the block's own surface is within reach;
  /// then the pixel's own expected depth decides.
  std::vector<float> nearest_in_reach_m, farthest_in_reach_m;
  std::vector<float> nearest_around_hole_m;  ///< within hole_reach_px; kNoDepth_m if there is none
  std::vector<int> reach;                    ///< max shift of an edge, in blocks to each side

  std::vector<float> nearest_level_m, farthest_level_m, along_rows_m;
  std::vector<float> row_nearest_m, row_farthest_m;
};

/// Nearest depth where the model has nothing.
inline constexpr float kNoDepth_m = 3.402823e38F;

/// Returns the combined error of sensor and model for a surface at depth_m that faces the camera.
/// @param misfit_per_m  error of the model's inverse depth, see model_fit.hpp
inline float facing_sigma_m(float depth_m, float model_sigma_m, float misfit_per_m) {
  const float sensor = depth_sigma_m(depth_m);
  const float misfit = misfit_per_m * depth_m * depth_m;
  return std::sqrt(sensor * sensor + model_sigma_m * model_sigma_m + misfit * misfit);
}

/// @param expected_m  depth of the static model in the camera's view, 0 = nothing there; not empty
void find_bounds(const DepthImage& expected_m, const Intrinsics& camera, const ForegroundConfig& config,
                 float misfit_per_m, ExpectedBounds& bounds);

}  // namespace roomradar
