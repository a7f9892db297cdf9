// feature_flow.hpp: constrains a pose by corners that are followed from image to image.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Corners of a frame's grey image with the points that they show. Depth is used at any distance: far points
/// constrain the rotation even where their depth is coarse.
struct FlowReference {
  Image<std::uint8_t> grey;
  std::vector<Eigen::Vector2f> corners_px;  ///< in `grey`
  std::vector<Eigen::Vector3d> p_camera;    ///< m, in the depth camera's frame
};

/// Finds up to 250 corners with a measured depth. Empty without colour.
/// @param grey  the frame's colour image in grey levels (0..255), of any size; see make_grey()
FlowReference make_flow_reference(const Frame& frame, const Image<float>& grey);

/// Returns true if depth does not constrain all directions clearly (Tracking::clear_information).
bool is_weak(const Tracking& aligned);

/// Result of constrain_by_flow().
struct FlowPose {
  Tracking tracking;  ///< the aligned pose, moved along the directions that depth constrains weakly
  /// False if too few corners were followed, or all directions were constrained and the corners agree within
  /// 3 cm; `tracking` is then unchanged.
  bool is_used = false;
  double followed = 0.0;  ///< fraction of the corners that agree with the pose
};

/// Follows the reference's corners into the frame (Lucas and Kanade), and minimises their reprojection errors
/// together with the clear constraints of depth. At least 20 corners, and half of those followed, must agree
/// within 2 px of the grey image. Source: Bouguet, Pyramidal implementation of the Lucas Kanade feature
/// tracker, 2001.
/// @param grey  the frame's colour image, of the size of the reference's
FlowPose constrain_by_flow(const FlowReference& reference, const Eigen::Isometry3d& T_world_reference,
                           const Frame& frame, const Image<float>& grey, const Tracking& aligned,
                           const AlignConfig& config);

}  // namespace roomradar
