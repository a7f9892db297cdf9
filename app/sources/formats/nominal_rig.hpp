// nominal_rig.hpp: default cameras for recordings that do not contain their intrinsics, and noise of sensors.
#pragma once
#include <filesystem>
#include <optional>

#include "app/sources/formats/camera_rig.hpp"

namespace roomradar {

enum class NominalRig {
  /// A Kinect v1 as published by 7-Scenes. Depth is not registered to colour.
  kSevenScenes,
  /// A Kinect v1 with depth registered to colour.
  kTum,
  /// The Xtion of the BONN RGB-D Dynamic Dataset, with depth registered to colour.
  kBonn,
  /// An unknown sensor.
  kNumbered,
  /// A Kinect v1 through libfreenect. Depth is not registered to colour.
  kKinect,
};

/// LiDAR of an iPhone or iPad, as ARKit's depth maps of 256 x 192 pixels. ARKit smooths the depth, so errors
/// of neighbouring pixels are correlated. On a Record3D export of a door, 0.5 to 1.5 m away, frames moved by
/// ARKit's poses differ by 1.7 mm (10 frames apart) to 4.1 mm (50 frames apart). This noise is chosen
/// somewhat larger, since tracking assumes independent errors of pixels: with half of it, 27 of the 60 frames
/// are not tracked.
inline constexpr DepthNoise kPhoneLidarNoise{0.002F, 0.004F, 0.0F, 0.0F, 0.0001F};

/// Time of flight of an Azure Kinect or Femto: about 1 mm at 1 m and 4 mm at 3.5 m. Source: Tolgyessy, Dekan,
/// Chovanec, Hubinsky, Evaluation of the Azure Kinect and Its Comparison to Kinect V1 and V2, Sensors 2021.
inline constexpr DepthNoise kTimeOfFlightNoise{0.001F, 0.0F, 0.0004F, 0.5F, 0.0001F};

/// Stereo of a RealSense D435: disparity is accurate to 0.08 px at a focal length of 640 px and a baseline of
/// 5 cm, so sigma = 0.08 z^2 / (640 * 0.05). Source: Intel, Best-Known-Methods for Tuning RealSense D400
/// Depth Cameras, section on RMS error.
inline constexpr DepthNoise kRealSenseNoise{0.0005F, 0.0F, 0.0025F, 0.0F, 0.0001F};

/// Distance of a PrimeSense's or Xtion's colour camera from its depth camera, m.
inline constexpr double kPrimeSenseBaseline_m = 0.025;

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// Returns the camera of a device of OpenNI, with square pixels, from the horizontal field of view that it
/// states, rad. A field of view outside 0.1 to 3 is replaced by that of a PrimeSense.
Intrinsics openni_camera(ImageSize size, double stated_fov_rad);

/// Returns published or measured default intrinsics for a kind of recording, scaled to the images' width. If
/// the images' aspect ratio differs from that of the calibrated images, equal numbers of rows are assumed to
/// be cropped at top and bottom.
CameraRig nominal_rig(NominalRig kind, ImageSize depth, std::optional<ImageSize> colour);

/// Returns the cameras of the recording in `folder`. Intrinsics come from the first of these sources that
/// exists: `chosen_depth`, the folder's camera.json, its camera-intrinsics.txt (depth camera only), and
/// nominal_rig(). Throws Error if a file is invalid. Also throws if a camera's size differs from the image
/// size. The message then contains both sizes and a remedy.
CameraRig rig_of_recording(const std::filesystem::path& folder, NominalRig kind,
                           const std::optional<Intrinsics>& chosen_depth, ImageSize depth,
                           std::optional<ImageSize> colour);

}  // namespace roomradar
