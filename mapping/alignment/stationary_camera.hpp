// stationary_camera.hpp: detects, from two images, that the camera did not move.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// Returns true if more than 60 % of the edge pixels of `before` (intensities 0..255) moved by less than 0.2 px.
/// The camera is then stationary; the other edges may belong to a moving person. For a camera that stood until
/// now, 40 % of the edges along x and of those along y suffice, spread over the image, and 18 % after five
/// frames: after a motion of a pixel, some 10 % are left by chance. A change of exposure is then compensated.
/// Returns false if the sizes differ or there are fewer than 300 edge pixels. Depth is not used, since a
/// stationary Kinect's depth changes while the sensor recalibrates.
/// @param stood_frames  number of frames for which the camera has stood; 0: it moved before
bool is_camera_stationary(const Image<float>& before, const Image<float>& now, int stood_frames = 0);

}  // namespace roomradar
