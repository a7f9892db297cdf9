// calibrated_source.hpp: a frame source that corrects lens distortion and depth errors.
#pragma once
#include <memory>

#include "app/calibration/calibration.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Returns a source that removes lens distortion and depth errors from each frame and sets the calibrated
/// cameras. Depth is resampled by nearest neighbour. Colour is interpolated. Pixels outside the original
/// image are 0. Allocates almost nothing after the first frame. next() throws Error if an image's size
/// differs from the calibration's.
std::unique_ptr<FrameSource> calibrated(std::unique_ptr<FrameSource> source, const Calibration& calibration);

}  // namespace roomradar
