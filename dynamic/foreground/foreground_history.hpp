// foreground_history.hpp: history of where the previous frame differed from the static model.
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
/// The same for regions too small or too new to be accepted at once.
inline constexpr std::uint8_t kBlockMaybeMoved = 4, kBlockMaybeRevealed = 8;

/// History of one camera. It is ignored for other intrinsics.
struct ForegroundHistory {
  BlockGrid grid;
  Intrinsics camera;  ///< without size: no history
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  bool is_empty = true;              ///< no block has a bit set
  std::vector<std::uint8_t> blocks;  ///< as seen by that camera, dilated by one block
  std::vector<std::uint8_t> along_rows;
};

/// Looks up the history of the places that this frame's blocks show, by the live depth in their middle.
/// @param before  bits per block, resized and set
void warp_history(const ForegroundHistory& memory, const DepthImage& depth_m, const Intrinsics& camera,
                  const Eigen::Isometry3d& T_world_camera, std::vector<std::uint8_t>& before);

/// Stores `memory.blocks`, as filled by the caller, as the new history. Dilates them by one block, since
/// things move between frames.
void store_history(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                   ForegroundHistory& memory);

}  // namespace roomradar
