// nominal_rig.hpp: the cameras of a kind of recording that does not say which cameras it was made with.
#pragma once
#include <filesystem>
#include <optional>

#include "app/sources/formats/camera_rig.hpp"

namespace roomradar {

enum class NominalRig {
  kSevenScenes,  ///< a Kinect v1 as 7-Scenes publishes it: depth and colour each from their own camera
  kTum,          ///< a Kinect v1 whose depth was registered to colour
  kNumbered,     ///< another sensor, of which nothing is known
  kKinect,       ///< a Kinect v1 through libfreenect, not registered
};

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// The kind's published or measured figures, scaled to the width of the images; where their height is another
/// one than this gives, rows are taken to be cut off above and below alike.
CameraRig nominal_rig(NominalRig kind, ImageSize depth, std::optional<ImageSize> colour);

/// The cameras of the recording in `folder`: `chosen_depth` if given, before the folder's camera.json, before
/// its camera-intrinsics.txt (depth camera only), before nominal_rig. Throws Error with both sizes and what
/// to do if the cameras are not of the images' sizes, or a file is broken.
CameraRig rig_of_recording(const std::filesystem::path& folder, NominalRig kind,
                           const std::optional<Intrinsics>& chosen_depth, ImageSize depth,
                           std::optional<ImageSize> colour);

}  // namespace roomradar
