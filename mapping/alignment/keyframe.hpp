// keyframe.hpp: stored views that later frames are aligned with, and refinement of their depth.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>

#include "mapping/alignment/view.hpp"

namespace roomradar {

/// Compact form of a view: 4 bytes per pixel, a tenth of the size of its pyramid and reference.
struct StoredView {
  Intrinsics camera;                   ///< camera of the pyramid's finest level
  Image<std::uint16_t> inverse_depth;  ///< in units of kInverseDepthStep_per_m; 0: no depth
  Image<std::uint8_t> intensity;       ///< 1..255; 0: none; empty image: no colour
  Image<std::uint8_t> measured;        ///< number of measurements averaged into the depth
};

/// Step of the 16-bit inverse depth, which covers depths from 0.27 m. The step equals 0.06 mm at 1 m and 2 mm
/// at 6 m, a thirtieth of a Kinect's noise there.
constexpr float kInverseDepthStep_per_m = 5.7e-5F;

struct Keyframe {
  std::int64_t frame_index = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::shared_ptr<const StoredView> view;  ///< never null; replaced, not modified, when the depth is refined
  std::uint32_t revision = 0;              ///< number of times the view was replaced
  /// Path length of the camera up to here, m; a radian counts as a metre, and unobserved motion counts
  /// tenfold. The drift between two keyframes is assumed to be a fraction of the path between them.
  double path_length_m = 0.0;
};

/// Stores the finest level of a pyramid. `measured` must have the level's size.
StoredView store(const ViewPyramid& pyramid, const Image<std::uint8_t>& measured);

/// Rebuilds the pyramid from the stored finest level.
void restore(const StoredView& view, const ViewConfig& config, ViewPyramid& pyramid);

/// Averages another view's depth into the finest level of `pyramid` where both see the same surface, and
/// increments `measured` there.
void improve_depth(ViewPyramid& pyramid, Image<std::uint8_t>& measured, const ViewPyramid& other,
                   const Eigen::Isometry3d& T_other_pyramid);

}  // namespace roomradar
