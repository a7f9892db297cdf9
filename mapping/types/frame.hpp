// frame.hpp: depth, colour, cameras and pose that a sensor delivers at one instant.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Times at which a sensor reads the rows of its images. Row y of h rows is read (y - (h - 1) / 2) / h *
/// readout_s after the middle of the image's readout. A readout of 0 s is a global shutter.
struct SensorTiming {
  double depth_readout_s = 0.0;
  double colour_readout_s = 0.0;
  /// Offset between the clocks of colour and depth: the true time of colour minus that of depth, both in the
  /// middle of their readouts, is the difference of their time stamps plus colour_delay_s.
  double colour_delay_s = 0.0;
  friend bool operator==(const SensorTiming&, const SensorTiming&) = default;
};

/// Images, cameras, pose and gravity of one instant. In names, `camera` alone means the depth camera.
struct Frame {
  std::int64_t index = 0;  ///< index in the recording from 0, skipped frames included
  double stamp_s = 0.0;    ///< sensor time; if the recording has no times, the number in the file name / 30

  DepthImage depth_m;  ///< same size as depth_camera
  Intrinsics depth_camera;
  DepthNoise depth_noise;

  ColourImage colour;  ///< same size as colour_camera; empty if the source has none
  Intrinsics colour_camera;
  double colour_after_depth_s = 0.0;  ///< colour time minus depth time; 0 if unknown
  /// Maps depth-camera points to colour-camera points.
  Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();

  SensorTiming timing;  ///< as the source states; all 0 if unknown

  std::optional<Eigen::Isometry3d> T_world_camera;  ///< depth camera's pose in the recording's world frame
  std::optional<Eigen::Vector3d> down_camera;       ///< unit direction of gravity in the camera frame
};

/// Copies everything but the images, which stay unchanged in `to`.
inline void copy_all_but_images(const Frame& from, Frame& to) {
  to.index = from.index;
  to.stamp_s = from.stamp_s;
  to.depth_camera = from.depth_camera;
  to.depth_noise = from.depth_noise;
  to.colour_camera = from.colour_camera;
  to.colour_after_depth_s = from.colour_after_depth_s;
  to.T_colour_depth = from.T_colour_depth;
  to.timing = from.timing;
  to.T_world_camera = from.T_world_camera;
  to.down_camera = from.down_camera;
}

/// A depth image, its camera and its pose. Refers to all three, which must outlive it.
struct PosedDepth {
  const DepthImage& depth_m;  ///< height x width, metres along the optical axis; 0: no measurement
  const Intrinsics& camera;   ///< of the image's size
  const Eigen::Isometry3d& T_world_camera;
};

}  // namespace roomradar
