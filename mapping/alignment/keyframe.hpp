// keyframe.hpp: a view that later ones are aligned with, its depth made better by what follows.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>

#include "mapping/alignment/view.hpp"

namespace roomradar {

/// A view as it is kept: 4 bytes a pixel, a tenth of what its pyramid and reference take.
struct StoredView {
  Intrinsics camera;                   ///< of the pyramid's finest level
  Image<std::uint16_t> inverse_depth;  ///< in kInverseDepthStep_per_m; 0: none
  Image<std::uint8_t> intensity;       ///< 1..255; 0: none; empty: no colour at all
  Image<std::uint8_t> measured;        ///< how many measurements the depth is the mean of
};

/// Reaches from 0.27 m on; the step is 0.06 mm at 1 m and 2 mm at 6 m, a thirtieth of a Kinect's noise there.
constexpr float kInverseDepthStep_per_m = 5.7e-5F;

struct Keyframe {
  std::int64_t frame_index = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::shared_ptr<const StoredView> view;  ///< never null; replaced, not changed, when the depth gets better
  std::uint32_t revision = 0;              ///< of the view: how often it was replaced
  /// How far the camera had gone, in metres (a radian counts as one): what drift may be in the poses between
  /// two keyframes is a part of the way between them. Where the motion was not seen it counts tenfold.
  double way_m = 0.0;
};

/// The finest level of a pyramid, as it is kept. `measured` has its size.
StoredView store(const ViewPyramid& pyramid, const Image<std::uint8_t>& measured);

/// The pyramid again, from the kept finest level.
void restore(const StoredView& view, const ViewConfig& config, ViewPyramid& pyramid);

/// Averages another view's depth into the finest level of `pyramid` where both see the same surface, and
/// counts it in `measured`.
void improve_depth(ViewPyramid& pyramid, Image<std::uint8_t>& measured, const ViewPyramid& other,
                   const Eigen::Isometry3d& T_other_pyramid);

}  // namespace roomradar
