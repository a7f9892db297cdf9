// calibrated_source.hpp: a frame source that corrects lens distortion and depth errors.
#pragma once
#include <memory>

#include "app/calibration/calibration.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Removes lens distortion and depth errors from every frame and sets the calibrated cameras. Depth is
/// resampled to the nearest pixel, never interpolated; colour is interpolated; pixels outside the original
/// image are 0. Allocates almost nothing after the first frame. next() throws Error if the images do not
/// match the calibration's size.
std::unique_ptr<FrameSource> calibrated(std::unique_ptr<FrameSource> source, const Calibration& calibration);

}  // namespace roomradar
