// foreground.hpp: which pixels of a depth frame differ from the static model, and how.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic/foreground/connected_components.hpp"
#include "dynamic/foreground/expected_bounds.hpp"
#include "dynamic/foreground/foreground_config.hpp"
#include "dynamic/foreground/foreground_history.hpp"
#include "dynamic/foreground/static_residual.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

enum class PixelLabel : std::uint8_t {
  kNotKnown,  ///< no live depth, no static model to compare it with, or a difference too small or new to tell
  kStatic,    ///< agrees with the static model as far as noise and pose error let one tell
  kMoved,     ///< nearer than the static model: something came in between
  kRevealed,  ///< farther than the static model: something was taken away
};
using LabelImage = Image<PixelLabel>;

/// What mark_foreground remembers of the frame before, and buffers that it reuses. A new one knows nothing.
struct ForegroundState {
  MovedMemory memory;
  ModelFit fit;

  ExpectedBounds bounds;
  std::vector<std::uint8_t> before;       // bits a block, see moved_memory.hpp
  std::vector<std::uint8_t> near_strong;  // evidence bits to keep, a block
  std::vector<std::uint8_t> block_evidence, along_rows;
  std::vector<std::uint8_t> revealed_for;  // of a block, see mark_revealed_cores
  std::vector<float> weak_m, strong_m;     // one value a pixel of a row
  std::vector<float> nearest_m, farthest_m, around_hole_m;
  std::vector<std::uint8_t> keep, row_bits;
  std::vector<std::uint8_t> evidence;  // bits a pixel, see foreground.cpp
  DepthRegions regions;
};

struct ForegroundCounts {
  std::size_t valid = 0;  ///< pixels with live depth
  std::size_t moved = 0;
  std::size_t revealed = 0;
  std::size_t not_known = 0;  ///< pixels with live depth that are kNotKnown
};

/// Compares a depth frame with what the static model would show at the same pose.
///
/// @param depth_m           live depth, height x width, metres along the axis, 0 = no measurement
/// @param expected_depth_m  the static model as the same camera sees it, same size, 0 = it has nothing there
/// @param camera            of both images
/// @param T_world_camera    its pose; what was marked in the frame before is looked up by it
/// @param state             of this camera; nothing is allocated from the second frame of a size on
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
/// nothing. A region is believed by its size and the part of it that is strong; less of both is asked where
/// one was in the frame before, and a small new one waits for a second frame.
ForegroundCounts mark_foreground(const DepthImage& depth_m, const DepthImage& expected_depth_m,
                                 const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                                 const ForegroundConfig& config, ForegroundState& state, LabelImage& labels,
                                 MaskImage& moved_mask);

}  // namespace roomradar
