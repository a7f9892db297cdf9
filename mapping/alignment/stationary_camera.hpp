// stationary_camera.hpp: detects, from two images, that the camera did not move.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// Returns true if enough edge pixels of `before` (intensities 0..255) moved by less than 0.2 px: more than
/// 60 %, or more than 35 % of those along x and of those along y, spread over the image. The camera is then
/// stationary; the other edges may belong to a moving person. For a camera that was stationary already, 18 %
/// suffice: after a motion of a pixel, some 10 % are left by chance. A change of exposure is compensated.
/// Returns false if the sizes differ or there are fewer than 300 edge pixels. Depth is not used, since a
/// stationary Kinect's depth changes while the sensor recalibrates.
bool is_camera_stationary(const Image<float>& before, const Image<float>& now, bool was_stationary = false);

}  // namespace roomradar
