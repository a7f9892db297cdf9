// foreground_history.hpp: stores the blocks of pixels in which the previous frame differed from the static
// model.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "dynamic/foreground/pixel_blocks.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Bits of a block of 4 x 4 pixels. Set if an accepted dynamic or revealed region (nearer or farther than the
/// static model) covers part of the block.
inline constexpr std::uint8_t kBlockMoved = 1, kBlockRevealed = 2;
/// Bits for regions so small that they are accepted only if they persist for a second frame.
inline constexpr std::uint8_t kBlockMaybeMoved = 4, kBlockMaybeRevealed = 8;

/// History of one camera, ignored if the intrinsics change.
struct ForegroundHistory {
  BlockGrid grid;
  Intrinsics camera;  ///< size 0 x 0: no history
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  bool is_empty = true;                  ///< no block has a bit set
  std::vector<std::uint8_t> blocks;      ///< bits per block of the previous frame, dilated by one block
  std::vector<std::uint8_t> along_rows;  ///< scratch
};

/// Warps the history into this frame. Back-projects each block's centre with its measured depth, and projects
/// the point into the previous frame. Copies the bits of the block to which it projects.
/// @param before  bits per block, resized and set; 0 for blocks without depth or history
void warp_history(const ForegroundHistory& memory, const DepthImage& depth_m, const Intrinsics& camera,
                  const Eigen::Isometry3d& T_world_camera, std::vector<std::uint8_t>& before);

/// Stores camera and pose, and dilates `memory.blocks` by one block, since objects move between frames. The
/// caller must have filled `memory.blocks`.
void store_history(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                   ForegroundHistory& memory);

}  // namespace roomradar
