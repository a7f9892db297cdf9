// nominal_noise.hpp: noise of depth sensors other than the Kinect v1, whose noise is the default of
// DepthNoise.
#pragma once
#include "mapping/types/depth_noise.hpp"

namespace roomradar {

/// LiDAR of an iPhone or iPad, as ARKit's depth maps of 256 x 192 pixels. ARKit smooths the depth, so errors
/// of neighbouring pixels are alike, and grow in proportion to depth. Source of the magnitude, 1 cm at a few
/// metres: Luetzenburg, Kroon, Bjork, Evaluation of the Apple iPhone 12 Pro LiDAR, Scientific Reports 2021.
inline constexpr DepthNoise kPhoneLidarNoise{0.003F, 0.005F, 0.0F, 0.0F, 0.0001F};

/// Time of flight of an Azure Kinect or Femto: about 1 mm at 1 m and 4 mm at 3.5 m. Source: Tolgyessy, Dekan,
/// Chovanec, Hubinsky, Evaluation of the Azure Kinect and Its Comparison to Kinect V1 and V2, Sensors 2021.
inline constexpr DepthNoise kTimeOfFlightNoise{0.001F, 0.0F, 0.0004F, 0.5F, 0.0001F};

/// Stereo of a RealSense D435: disparity is accurate to 0.08 px at a focal length of 640 px and a baseline of
/// 5 cm, so sigma = 0.08 z^2 / (640 * 0.05). Source: Intel, Best-Known-Methods for Tuning RealSense D400
/// Depth Cameras, section on RMS error.
inline constexpr DepthNoise kRealSenseNoise{0.0005F, 0.0F, 0.0025F, 0.0F, 0.0001F};

}  // namespace roomradar
