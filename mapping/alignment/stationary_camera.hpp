// stationary_camera.hpp: detects, from two images, that the camera did not move.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// Returns true if more than 60 % of the edge pixels of `before` (intensities 0..255) moved by less than 0.2
/// px. The camera is then stationary; the other edges may belong to a moving person. Returns false if the
/// sizes differ or there are fewer than 300 edge pixels. Depth is not used, since a stationary Kinect's depth
/// changes while the sensor recalibrates.
bool is_camera_stationary(const Image<float>& before, const Image<float>& now);

}  // namespace roomradar
