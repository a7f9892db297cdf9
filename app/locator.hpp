// locator.hpp: where the camera is in the saved room, frame by frame.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>

#include "mapping/align.hpp"
#include "mapping/places.hpp"
#include "mapping/view.hpp"

namespace roomradar {

/// The depth that the room's static model shows at a pose, of the live depth image's size.
using ExpectedDepth = std::function<const DepthImage&(const Eigen::Isometry3d& T_world_camera)>;

/// What is remembered from frame to frame, and buffers that are reused.
struct Locator {
  ViewConfig live_view;
  ViewConfig expected_view{.noisy = false};  ///< rendered depth needs no smoothing
  AlignConfig align;
  RelocaliseConfig relocalise;
  std::optional<Eigen::Isometry3d> T_world_camera;  ///< of the last frame; nothing while lost
  /// Motion from the frame before to the last one.
  Eigen::Isometry3d T_last_now = Eigen::Isometry3d::Identity();

  ViewPyramid live_pyramid, expected_pyramid;
  LiveView live;
  ReferenceView expected;
};

/// Finds the frame's camera: by alignment with the expected depth at the pose predicted from the last motion,
/// or, when that fails or nothing is known, by relocalisation among the places and alignment from there.
///
/// @param moved_mask  of the frame before: pixels at 255 moved and are left out; empty, or of the depth's
/// size
/// @return with status kTracked or kDegenerate a pose to go on with (in kDegenerate the directions that the
///         room does not fix are the prediction's, or it is the last frame's pose, where the sensor's
///         depth bent and alignment took that for a motion); any other status: not located, the next frame
///         starts anew
Tracking locate(Locator& locator, const Frame& frame, const Places& places, const MaskImage& moved_mask,
                const ExpectedDepth& expected_depth);

}  // namespace roomradar
