// foreground.hpp: labels the pixels of a depth frame that differ from the static model.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic/foreground/connected_components.hpp"
#include "dynamic/foreground/expected_bounds.hpp"
#include "dynamic/foreground/foreground_config.hpp"
#include "dynamic/foreground/foreground_history.hpp"
#include "dynamic/foreground/pixel_evidence.hpp"
#include "dynamic/foreground/static_residual.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// History of the previous frame, and reused buffers. A new state has no history.
struct ForegroundState {
  ForegroundHistory memory;
  StaticResidual fit;

  ExpectedBounds bounds;
  std::vector<std::uint8_t> before;  // bits per block, see foreground_history.hpp
  PixelEvidence evidence;
  ConnectedComponents regions;
};

struct ForegroundCounts {
  std::size_t valid = 0;  ///< pixels with live depth
  std::size_t moved = 0;
  std::size_t revealed = 0;
  std::size_t not_known = 0;  ///< pixels with live depth that are kNotKnown
};

/// Compares a depth frame with the static model's depth at the same pose.
///
/// @param depth_m           live depth, height x width, metres along the axis, 0 = no measurement
/// @param expected_depth_m  the static model seen by the same camera, same size, 0 = nothing there
/// @param camera            intrinsics of both images
/// @param T_world_camera    camera pose; the previous frame's labels are looked up with it
/// @param state             of this camera; nothing is allocated from the second frame of a size on
/// @param labels            resized and set
/// @param dynamic_mask        255 where the label is kMoved, else 0; resized and set
/// The three sizes must agree (asserted).
///
/// A pixel seeds a dynamic region only if it is nearer than the model there. In addition, it must be nearer
/// than all of the model within reach of an edge error, or at a depth where no surface within reach is
/// expected. Edges shifted by a pose error thus stay static, while things that appear between two near edges
/// do not. From its seeds a region grows along the live surface over pixels that are nearer than the model
/// there. No region starts in a hole of the model, but a region can grow into a hole over pixels nearer than
/// all expected depth within hole_reach_px. Everything else in a hole, and all of an unmapped view, is
/// kNotKnown: a hole proves nothing. A region is accepted by its size and its fraction of strong pixels. Both
/// thresholds are lower where the previous frame had a region; a small new region waits for a second frame.
ForegroundCounts mark_foreground(const DepthImage& depth_m, const DepthImage& expected_depth_m,
                                 const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                                 const ForegroundConfig& config, ForegroundState& state, LabelImage& labels,
                                 MaskImage& dynamic_mask);

}  // namespace roomradar
