// stationary_camera.hpp: detects that the camera did not move between two images.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// Returns true if most edges of `before` (intensities 0..255) moved by less than a fifth of a pixel. The
/// camera is then stationary, even if something moves in front of it. Returns false if the sizes differ or
/// there are fewer than 300 edge pixels. Requiring only a majority ignores a moving person. Depth is not used
/// because a stationary Kinect recalibrates.
bool is_camera_stationary(const Image<float>& before, const Image<float>& now);

}  // namespace roomradar
