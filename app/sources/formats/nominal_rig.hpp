// nominal_rig.hpp: default cameras for recordings that do not contain their intrinsics.
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

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

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
