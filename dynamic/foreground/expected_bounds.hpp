// expected_bounds.hpp: bounds of the static model's depth under pose and map errors, per block of pixels.
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "dynamic/foreground/foreground_config.hpp"
#include "dynamic/foreground/pixel_blocks.hpp"
#include "dynamic/foreground/unmapped_space.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Bounds of the expected depth (the static model's depth), and scratch buffers. Each vector has one value
/// per block of 4 x 4 pixels. Depths are in metres along the optical axis.
struct ExpectedBounds {
  BlockGrid grid;
  /// Extremes of the block's expected depths; kNoDepth_m and 0 if the block has none. In a block without any
  /// model, both are the background that the run has seen, if any.
  std::vector<float> nearest_m, farthest_m;
  std::vector<float> model_m;  ///< farthest depth of the model in the block; 0: none
  /// 1 if the block's surface is a small one in the middle of a hole. It may be the rest of a thing that the
  /// scan took for a part of the room, such as a person who stood still for a while.
  std::vector<std::uint8_t> is_island;
  /// Depth to compare with in the model's holes: the background that the run has seen; 0: none.
  std::vector<float> background_m;
  /// Standard deviation of measured minus expected depth, from all errors combined.
  std::vector<float> sigma_m;
  /// Range of the expected depths within `reach` of the block. Pose and map errors could shift the edges of
  /// these surfaces into the block. nearest_in_reach_m is kNoDepth_m if no surface within reach is in front
  /// of the block's own surface, continued as a plane. farthest_in_reach_m is 0 if none is behind that plane,
  /// and kNoDepth_m if a hole of the model (pixels without expected depth) is within reach. If
  /// nearest_in_reach_m is kNoDepth_m or farthest_in_reach_m is 0, a pixel is compared on that side only with
  /// its own expected depth.
  std::vector<float> nearest_in_reach_m, farthest_in_reach_m;
  /// For pixels in the model's holes and islands: nearest depth of the rest of the model within hole_reach_px
  /// of the block or, if there is none, of the hole's border. kNoDepth_m: the view has no model.
  std::vector<float> nearest_around_hole_m;
  std::vector<int> reach;  ///< max shift of an edge, in blocks to each side

  // Scratch.
  std::vector<float> nearest_level_m, farthest_level_m, along_rows_m;
  std::vector<float> row_nearest_m, row_farthest_m;
  struct BlockRun {
    int row, first, last;  ///< columns first to last
    std::size_t parent;    ///< in union-find
    std::size_t blocks;    ///< of all runs whose parent is this one
  };
  std::vector<BlockRun> runs;
};

/// Largest float: "no surface" as a nearest depth, "unbounded" as a farthest depth.
inline constexpr float kNoDepth_m = 3.402823e38F;

/// Returns the combined standard deviation of sensor noise and model error, for a surface at depth_m that
/// faces the camera.
/// @param misfit_per_m  error of the model's inverse depth (StaticResidual::misfit_per_m)
inline float facing_sigma_m(const DepthNoise& noise, float depth_m, float model_sigma_m, float misfit_per_m) {
  const float sensor = depth_sigma_m(noise, depth_m);
  const float misfit = misfit_per_m * depth_m * depth_m;
  return std::sqrt(sensor * sensor + model_sigma_m * model_sigma_m + misfit * misfit);
}

/// Computes the bounds of each block. Warps `unmapped` into the camera's view.
/// @param expected  depth of the static model in the camera's view, 0 = no surface; must not be an empty
/// image
/// @param unmapped  what the run has seen where the model has no surface
void find_bounds(const PosedDepth& expected, const ForegroundConfig& config, float misfit_per_m,
                 UnmappedSpace& unmapped, ExpectedBounds& bounds);

}  // namespace roomradar
