// nominal_rig.hpp: default cameras for recordings that do not contain their intrinsics, and noise of sensors.
#pragma once
#include <optional>

#include "app/sources/formats/camera_rig.hpp"

namespace roomradar {

enum class NominalRig {
  /// The Kinect v1 of 7-Scenes: depth intrinsics as published, colour fitted. Depth is not registered to
  /// colour.
  kSevenScenes,
  /// A Kinect v1 with depth registered to colour.
  kTum,
  /// The Xtion of the BONN RGB-D Dynamic Dataset, with depth registered to colour.
  kBonn,
  /// A folder of numbered images from an unknown sensor, with intrinsics fitted to one such recording. Depth
  /// is not registered to colour.
  kNumbered,
  /// A Kinect v1 through libfreenect. Depth is not registered to colour.
  kKinect,
};

/// Noise of an iPhone's or iPad's LiDAR in ARKit's depth maps of 256 x 192 pixels. ARKit smooths the depth,
/// so errors of neighbouring pixels are correlated. In a Record3D recording of a door at 0.5 to 1.5 m, depths
/// of two frames that are aligned by ARKit's poses differ by 1.7 mm (median, 10 frames apart) to 4.1 mm (50
/// frames apart). kPhoneLidarNoise is about twice as large, since tracking assumes that the errors of pixels
/// are independent. With half of kPhoneLidarNoise, 27 of the recording's 60 frames are not tracked.
inline constexpr DepthNoise kPhoneLidarNoise{0.002F, 0.004F, 0.0F, 0.0F, 0.0001F};

/// Depth noise of the time-of-flight sensors Azure Kinect and Femto: 1.1 mm at 1 m and 4.6 mm at 3.5 m.
/// Source: Tolgyessy, Dekan, Chovanec, Hubinsky, Evaluation of the Azure Kinect and Its Comparison to Kinect
/// V1 and V2, Sensors 2021.
inline constexpr DepthNoise kTimeOfFlightNoise{0.001F, 0.0F, 0.0004F, 0.5F, 0.0001F};

/// Noise of a RealSense D435's stereo depth: disparity is accurate to 0.08 px at a focal length of 640 px and
/// a baseline of 5 cm, so sigma = 0.5 mm + 0.08 z^2 / (640 * 0.05). Source: Intel, Best-Known-Methods for
/// Tuning RealSense D400 Depth Cameras, section on RMS error.
inline constexpr DepthNoise kRealSenseNoise{0.0005F, 0.0F, 0.0025F, 0.0F, 0.0001F};

/// Distance of a PrimeSense's or Xtion's colour camera from its depth camera, m.
inline constexpr double kPrimeSenseBaseline_m = 0.025;

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// Returns the intrinsics of an OpenNI device, with square pixels.
/// @param stated_fov_rad  horizontal field of view that the device reports, rad; outside 0.1 to 3, that of a
///                        PrimeSense is used
Intrinsics openni_camera(ImageSize size, double stated_fov_rad);

/// Returns the intrinsics of an iPhone's or iPad's main camera in ARKit's images: a focal length of 0.71
/// times the longer side. Of two recordings of different devices, one has 0.69, one has 0.73.
Intrinsics phone_camera(ImageSize size);

/// Returns published or measured default intrinsics for a kind of recording, scaled to the images' width. If
/// the images' aspect ratio differs from that of the calibrated images, equal numbers of rows are assumed to
/// be cropped at top and bottom.
CameraRig nominal_rig(NominalRig kind, ImageSize depth, std::optional<ImageSize> colour);

/// Returns the camera scaled to images of another width. If the aspect ratio differs, equal numbers of rows
/// are assumed to be cropped at top and bottom.
Intrinsics fitted_to(const Intrinsics& camera, ImageSize size);

/// Returns whose cameras nominal_rig() returns, for messages: "the Kinect v1 of 7-Scenes".
const char* nominal_name(NominalRig kind);

}  // namespace roomradar
