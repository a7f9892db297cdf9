// moved_memory.hpp: where the frame before differed from the static model, carried along with the camera.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "dynamic/foreground/pixel_blocks.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Bits of a block of pixels.
inline constexpr std::uint8_t kBlockMoved = 1, kBlockRevealed = 2;
/// The same for regions that were too small or too new to be believed at once.
inline constexpr std::uint8_t kBlockMaybeMoved = 4, kBlockMaybeRevealed = 8;

/// Belongs to one camera; another one's memory is as good as none.
struct MovedMemory {
  BlockGrid grid;
  Intrinsics camera;  ///< of no size: nothing is remembered
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  bool is_empty = true;              ///< no block has a bit
  std::vector<std::uint8_t> blocks;  ///< as that camera saw them, and their neighbours
  std::vector<std::uint8_t> along_rows;
};

/// What is remembered of the places that this frame's blocks show, by the live depth in their middle.
/// @param before  bits a block, resized and set
void recall(const MovedMemory& memory, const DepthImage& depth_m, const Intrinsics& camera,
            const Eigen::Isometry3d& T_world_camera, std::vector<std::uint8_t>& before);

/// Replaces what is remembered by `memory.blocks` as the caller has filled it, widened by a block: things
/// move between frames.
void remember(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, MovedMemory& memory);

}  // namespace roomradar
