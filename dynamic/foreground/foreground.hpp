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
  std::vector<std::uint8_t> before;  // history bits per block, warped into this frame
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
/// @param T_world_camera    camera pose; used to warp the previous frame's regions into this frame
/// @param state             one per camera; only the first frame of a size allocates
/// @param labels            resized and set
/// @param dynamic_mask        255 where the label is kMoved, else 0; resized and set
/// The two images and the camera must agree in size (asserted).
///
/// A pixel seeds a dynamic region only if it is clearly nearer than the model at that pixel. In addition, it
/// must be nearer than every model surface within reach (the max shift of an edge by pose and map errors), or
/// at a depth where no surface within reach is expected. So edges shifted by a pose error stay static, and
/// objects between two near edges are found. From its seeds a region grows along the live surface over pixels
/// nearer than the model. No region starts in a hole of the model, but a region can grow into a hole over
/// pixels nearer than all expected depths within hole_reach_px. All other pixels in holes, and all of an
/// unmapped view, are kNotKnown: a hole proves nothing. A region is accepted if it is large enough and has a
/// sufficient fraction of strong pixels. Both thresholds are lower where the previous frame had a region; a
/// small new region waits for a second frame.
ForegroundCounts mark_foreground(const DepthImage& depth_m, const DepthImage& expected_depth_m,
                                 const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                                 const ForegroundConfig& config, ForegroundState& state, LabelImage& labels,
                                 MaskImage& dynamic_mask);

}  // namespace roomradar
