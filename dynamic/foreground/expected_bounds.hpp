// expected_bounds.hpp: how far from the expected depth the static room can show itself, block by block.
#pragma once
#include <cmath>
#include <vector>

#include "dynamic/foreground/foreground_config.hpp"
#include "dynamic/foreground/pixel_blocks.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// One value a block of 4 x 4 pixels, and buffers to find them. Metres along the optical axis.
struct ExpectedBounds {
  BlockGrid grid;
  std::vector<float> nearest_m, farthest_m;  ///< expected depth in the block; kNoDepth_m and 0 where none is
  std::vector<float> sigma_m;                ///< of live depth minus expected depth, all errors together
  /// Beyond these no edge of the model reaches that an error of the pose could shift here; farthest is
  /// kNoDepth_m where a hole is in reach. kNoDepth_m and 0 where nothing but the block's own surface is in
  /// reach: there the pixel's own depth decides.
  std::vector<float> nearest_in_reach_m, farthest_in_reach_m;
  std::vector<float> nearest_around_hole_m;  ///< within hole_reach_px; kNoDepth_m where there is none
  std::vector<int> reach;                    ///< blocks to each side that an edge may be off

  std::vector<float> nearest_level_m, farthest_level_m, along_rows_m;
  std::vector<float> row_nearest_m, row_farthest_m;
};

/// "Nearest" where the model has nothing.
inline constexpr float kNoDepth_m = 3.402823e38F;

/// Sensor's and model's error together, for a surface at depth_m that faces the camera.
/// @param misfit_per_m  error of the model's inverse depth, see model_fit.hpp
inline float facing_sigma_m(float depth_m, float model_sigma_m, float misfit_per_m) {
  const float sensor = depth_sigma_m(depth_m);
  const float misfit = misfit_per_m * depth_m * depth_m;
  return std::sqrt(sensor * sensor + model_sigma_m * model_sigma_m + misfit * misfit);
}

/// @param expected_m  the static model as the camera sees it, 0 = it has nothing there; not empty
void find_bounds(const DepthImage& expected_m, const Intrinsics& camera, const ForegroundConfig& config,
                 float misfit_per_m, ExpectedBounds& bounds);

}  // namespace roomradar
