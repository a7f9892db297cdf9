// unmapped_space.hpp: what this run has seen where the static model has no surface: the farthest surface, and
// what came while the camera looked.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "dynamic/foreground/pixel_blocks.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A surface seen in one block of 4 x 4 pixels.
struct BlockSurface {
  Eigen::Vector3f p_world_m = Eigen::Vector3f::Zero();
  float depth_m = 0.0F;        ///< in the camera of UnmappedSpace; 0: none
  std::uint8_t frames = 0;     ///< number of frames that agreed, up to a limit
  std::uint8_t unseen = 0;     ///< number of frames without any measurement since
  std::uint8_t has_come = 0;   ///< 1: it is nearer than what was there, or nothing was there
  std::uint8_t has_moved = 0;  ///< 1: the last frame found it dynamic
  std::uint8_t walks = 0;      ///< 1: it is part of a surface that was found moving as a whole
  std::uint8_t grown = 0;  ///< frames since it got into a block in which nothing was measured; 0: it did not
};

/// How a connected surface moved within half a second, in blocks of 4 x 4 pixels.
struct SurfaceMotion {
  struct Blocks {
    double count = 0.0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();  ///< of columns and rows
    double sum_of_squares = 0.0;
    void add(int column, int row) {
      const Eigen::Vector2d at(column, row);
      count += 1.0, sum += at, sum_of_squares += at.squaredNorm();
    }
  };
  Blocks all;                 ///< blocks in which it is
  Blocks entered, left;       ///< blocks in which nothing was measured before, and since
  double walking = 0.0;       ///< number of blocks of a surface that was found moving, and still is dynamic
  double beside_model = 0.0;  ///< number of blocks beside which the model goes on at the same depth
};

/// Memory of one camera, ignored if the intrinsics change. All vectors have one value per block.
struct UnmappedSpace {
  BlockGrid grid;
  Intrinsics camera;  ///< size 0 x 0: nothing was seen so far
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::vector<BlockSurface> farthest;  ///< the farthest surface so far
  std::vector<BlockSurface> nearest;   ///< the surface of the last frames
  std::vector<std::uint8_t> empty;     ///< number of last frames in which nothing was measured there
  /// 1 for rows and columns of blocks in which anything was ever measured. Others near the image's border are
  /// the sensor's margin, in which nothing can be measured.
  std::vector<std::uint8_t> row_measures, column_measures;
  std::int64_t frames = 0;

  std::vector<BlockSurface> reached;  // scratch
  std::vector<std::uint8_t> empty_before;
  std::vector<float> measured_m;  // farthest measured depth of this frame, set by see_what_came()
  std::vector<std::int32_t> surface_of;  // connected surface of each block; -1: none
  std::vector<std::size_t> reached_blocks;
  std::vector<SurfaceMotion> motions;  // of the connected surfaces
};

/// Moves the memory into this frame's view. What leaves the view, or gets into a block with a model, is
/// forgotten.
/// @param model_m  per block: depth of the static model; 0: none
void warp_unmapped(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                   const std::vector<float>& model_m, UnmappedSpace& space);

/// Updates `nearest` and `empty` from this frame, in the blocks without any surface of the model. A surface
/// has come if nothing was measured there in the last frames, or if it goes on with one that has come and was
/// dynamic. But where it goes on with the model, or with a surface that has been there for a while, it is a
/// part of that, which was not measured before, unless the whole surface moves: within half a second, it got
/// into blocks on one side where nothing was, and out of blocks on the other side.
/// @param model_m  per block: depth of the static model; 0: none
void see_what_came(const DepthImage& depth_m, const std::vector<float>& model_m, const DepthNoise& noise,
                   UnmappedSpace& space);

/// Returns true if the surface in a block has come, and moved in the last half second. Surfaces that
/// see_background() finds moved count as moving for some seconds more.
bool is_moving(const BlockSurface& nearest);

/// Updates `farthest` in the blocks without any surface of the model. A farther measurement replaces what was
/// seen; one within noise is averaged with the first ones. Pixels that have moved do not count.
void see_background(const DepthImage& depth_m, const MaskImage& dynamic_mask,
                    const std::vector<float>& model_m, const DepthNoise& noise, UnmappedSpace& space);

}  // namespace roomradar
