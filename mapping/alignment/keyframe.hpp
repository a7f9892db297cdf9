// keyframe.hpp: compact keyframes. Later frames are aligned with a keyframe, and their depth is averaged into
// it.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>

#include "mapping/alignment/view.hpp"

namespace roomradar {

/// Compact form of a ViewPyramid (depth and intensity at several resolutions). Takes 4 bytes per pixel, a
/// tenth of the size of the pyramid and its TargetView.
struct StoredView {
  Intrinsics camera;  ///< camera of the finest level, the only level stored
  DepthNoise noise;
  Image<std::uint16_t> inverse_depth;  ///< in units of kInverseDepthStep_per_m; 0: no depth
  Image<std::uint8_t> intensity;       ///< 1..255; 0: unknown; empty image: no colour
  Image<std::uint8_t> measured;        ///< number of measurements averaged into each pixel's depth
};

/// Step of the 16-bit inverse depth, 1/m. Depths from 0.27 m upwards can be represented. The step corresponds
/// to 0.06 mm at 1 m, and to 2 mm at 6 m, a thirtieth of a Kinect's noise there.
constexpr float kInverseDepthStep_per_m = 5.7e-5F;

struct PackedView;

struct Keyframe {
  std::int64_t frame_index = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::shared_ptr<const PackedView> view;  ///< never null; refined depth is stored as a new view
  std::uint32_t revision = 0;              ///< number of times that `view` was replaced
  /// Length of the camera's path up to this keyframe, m. A rotation by 1 rad counts as 1 m, and motion while
  /// tracking was degenerate counts tenfold. The assumed drift between two keyframes grows with the length of
  /// the path between them.
  double path_length_m = 0.0;
  CameraVelocity velocity = {};         ///< of the camera at `frame_index`
  CameraVelocity steady_velocity = {};  ///< mean over several frames up to `frame_index`
  SensorTiming timing = {};             ///< sensor times used to register the view's intensity to its depth
  /// Pose in the recording's world; unset if the recording has none, or recorded poses are not used.
  std::optional<Eigen::Isometry3d> T_recorded_camera = {};
  /// Part of the scan: parts begin where tracking was lost, and their relative poses are unknown.
  int part = 0;
  /// Depth constrained the pose weakly, and corners constrained it; see constrain_by_flow().
  bool is_by_flow = false;
  std::int64_t stretch = 0;  ///< MotionPrior::stretch of T_recorded_camera
};

/// Returns a measure of how much two viewpoints differ: distance / 0.8 m + angle / 35 degrees. At 1, the two
/// views hardly overlap.
double view_distance(const Eigen::Isometry3d& T_a_b);

/// Returns the pyramid's finest level in compact form. `measured` must have that level's size.
StoredView store(const ViewPyramid& pyramid, const Image<std::uint8_t>& measured);

/// Rebuilds the pyramid from the stored finest level.
void restore(const StoredView& view, const ViewConfig& config, ViewPyramid& pyramid);

/// Averages the depth of `other` into the finest level of `pyramid`, in the pixels where both show the same
/// surface. Increments `measured` in these pixels, up to 60. From there on, the mean is an exponential moving
/// average.
void improve_depth(ViewPyramid& pyramid, Image<std::uint8_t>& measured, const ViewPyramid& other,
                   const Eigen::Isometry3d& T_other_pyramid);

}  // namespace roomradar
